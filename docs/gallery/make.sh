#!/usr/bin/env bash
# Draws the figures of docs/gallery.md again, with the command `asperity`, or the one that is given.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

asperity="${1:-asperity}"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Runs an example or a case of this folder, and keeps one figure of it.
figure() {
    local name=$1 results="$work/$1"
    if [ -s "$name.toml" ]; then
        [ -d "$results" ] || "$asperity" run "$name.toml" --out "$results" --quiet
    else
        [ -d "$results" ] || "$asperity" run --example "$name" --out "$results" --quiet
        results="$results/results"
    fi
    "$asperity" plot "$results" --only "$2" --dpi 150
    cp "$results/figures/$2.png" "$name-$2.png"
}

figure rough-ball pressure
figure load-curve contact_area
figure hertz subsurface
figure friction loading
figure friction shear
figure traction traction
figure measured contact
"$asperity" example measured --out "$work/measured-files"
"$asperity" surface plot "$work/measured-files/disc.x3p" --fill harmonic --level plane --dpi 150 --out "$work/disc"
cp "$work/disc/relief.png" disc-relief.png
cp "$work/disc/spectrum.png" disc-spectrum.png
