#!/usr/bin/env bash
# Makes DejaVuSans-small.ttf, with fonttools (`pip install fonttools`).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
pyftsubset DejaVuSans.ttf --output-file=DejaVuSans-small.ttf --layout-features='' --no-hinting --glyph-names \
    --drop-tables+=GSUB,GPOS,GDEF,kern \
    --unicodes="U+0020-007E,U+00A0-017F,U+0391-03C9,U+03D1,U+03D5,U+2010-2027,U+2030-203A,U+2070-209C,U+20AC,U+2100-214F,U+2190-21FF,U+2200-22FF,U+25A0-25CF,U+2713"
