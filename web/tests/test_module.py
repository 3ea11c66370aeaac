"""The module alone: it computes what the command computes, and survives every file."""

import json
import subprocess

import pytest

from conftest import ROOT, Failure, assert_close, compared

CORPUS = ROOT / "crates/asperity-surface/fuzz/corpus"
# Examples that a browser computes in some seconds; the others take the command minutes.
EXAMPLES = ["quickstart", "measured", "hertz", "friction", "fretting", "pull-off", "seal", "viscoelastic", "micropitting", "study", "contact-challenge"]
# The command and the module compute the same contact: where both solve it closely, and meet the load of a pass as closely, their numbers
# are within ten times as much.
SOLVED, CLOSE = 1e-10, 1e-9


def solved_closely(tables):
    """The tables of a case, with tolerances far below those that a user needs."""
    tables["contact"]["tolerance"] = SOLVED
    if "motion" in tables:
        tables["motion"]["load_tolerance"] = CLOSE
    return tables


@pytest.mark.parametrize("name", EXAMPLES)
def test_numbers_are_those_of_the_command(module, asperity, tmp_path, name):
    case = module("example", name)
    subprocess.run([asperity, "example", name], check=True, cwd=tmp_path, stdout=subprocess.DEVNULL)
    path = tmp_path / case
    assert path.read_bytes() == module("get", case)
    text = module("write_case", json.dumps(solved_closely(module("read_case", path.read_text()))))
    path.write_text(text)
    module("put", case, text.encode())
    module("run", case, f"{name}/here", "keep")
    subprocess.run([asperity, "run", path, "--out", tmp_path / "there", "--quiet"], check=True, stderr=subprocess.DEVNULL)
    here, there = (json.loads(text) for text in (module("get", f"{name}/here/summary.json"), (tmp_path / "there/summary.json").read_bytes()))
    assert_close(compared(here), compared(there), 10 * CLOSE)
    files = {each["name"].removeprefix(f"{name}/here/") for each in module("files", f"{name}/here")}
    written = {str(each.relative_to(tmp_path / "there")) for each in (tmp_path / "there").rglob("*") if each.is_file()}
    # The module draws a figure when it is asked for.
    assert {each for each in written if not each.startswith(("figures/", "."))} == {each for each in files if not each.startswith(".")}
    module("report", f"{name}/here")
    assert b'<h1>' in module("get", f"{name}/here/report.html")
    figures = module("figures", f"{name}/here")
    assert {f"figures/{figure}.png" for figure in figures} >= {each for each in written if each.startswith("figures/") and each.endswith(".png")}
    for format, begin in (("png", b"\x89PNG"), ("svg", b"<"), ("pdf", b"%PDF")):
        assert module("figure", f"{name}/here", figures[0], format).startswith(begin)
    module("remove", name)


def files_of_corpora():
    return [path for folder in sorted(CORPUS.iterdir()) for path in sorted(folder.iterdir())]


@pytest.mark.parametrize("path", files_of_corpora(), ids=lambda path: f"{path.parent.name}-{path.name[:12]}")
def test_a_file_is_read_or_is_an_error(module, path):
    module("put", "file", path.read_bytes())
    try:
        found = module("scan", "file", "")
    except Failure as failure:
        assert failure.failure["message"] and not failure.failure["broken"], failure.failure
    else:
        assert len(found["shape"]) == 2
    module("remove", "file")


def test_a_prepared_surface_is_read_again(module):
    module("example", "measured")
    table = {"file": "measured/disc.x3p", "fill": "harmonic", "level": "plane"}
    before = module("surface", table)["about"]
    module("put", "again.x3p", module("prepared", table, "again.x3p"))
    after = module("surface", {"file": "again.x3p"})["about"]
    assert after["shape"] == before["shape"] and after["undefined"] == 0
    assert after["max"] - after["min"] == pytest.approx(before["max"] - before["min"], rel=1e-9)


def test_tables_and_text_are_the_same_case(module):
    module("example", "quickstart")
    text = module("get", "quickstart/case.toml").decode()
    tables = module("read_case", text)
    assert tables["lower"]["topography"]["shape"] == [64, 64]
    again = module("read_case", module("write_case", json.dumps(tables)))
    assert again == tables
    rigid = module("write_case", json.dumps({"upper": {"young": "inf", "hardness": "2 GPa"}}))
    assert "young = inf" in rigid and module("read_case", rigid)["upper"]["young"] == "inf"
    with pytest.raises(Failure) as failed:
        module("read_case", "[lower\n")
    assert failed.value.failure["line"] == 1
