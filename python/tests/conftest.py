"""What several tests share: small surfaces, materials."""

from __future__ import annotations

import asperity as asp
import pytest


def rough(seed: int, shape: tuple[int, int] = (32, 32), sq: float = 50e-9) -> asp.Surface:
    return asp.generate.low_pass(shape, pitch="1 um", sq=sq, cutoff="8 um", seed=seed)


@pytest.fixture
def steel() -> asp.Material:
    return asp.Material(young="210 GPa", poisson=0.3, hardness="4 GPa")


@pytest.fixture
def pair(steel: asp.Material) -> tuple[asp.Body, asp.Body]:
    return asp.Body(rough(1), steel), asp.Body(rough(2), steel)
