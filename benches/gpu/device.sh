#!/usr/bin/env bash
# Checks and times contacts on the GPU of a machine that has nothing of ours: twenty contacts against the processor, periodic
# contacts of 512² to 32768², a pass, a free contact of 8192², and the Contact-Mechanics Challenge up to 65536². It takes less
# than five minutes.
#
#     cargo bench -p asperity-contact --features cuda --bench gpu --no-run     # on any x86-64 machine; prints the program
#     cargo build --release -p asperity-cli --features cuda
#     benches/gpu/device.sh PROGRAM [agree|periodic|pass|free|challenge ...]    # on the machine with the GPU
#
# With ASPERITY=target/release/asperity and a Python it also runs the examples on the GPU and on the processor.
set -euo pipefail

program=$1
shift

# NVRTC and cuFFT may lie where the loader does not look: in a toolkit, or in Python packages.
for library in libnvrtc libcufft; do
    ldconfig -p 2>/dev/null | grep -q "$library\.so" && continue
    found=$(find /usr/local/cuda*/lib64 /usr/local/cuda*/targets/*/lib /opt /usr/lib/python3* /usr/local/lib/python3* "$HOME" \
        -name "$library.so*" -print -quit 2>/dev/null || true)
    [ -z "$found" ] || export LD_LIBRARY_PATH="$(dirname "$found")${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
done

timeout 300 "$program" "$@"
if [ -n "${ASPERITY:-}" ]; then
    printf '\n== examples\n'
    timeout 200 python3 "$(dirname "${BASH_SOURCE[0]}")/examples.py" "$ASPERITY" quickstart hertz measured running-in seal
fi
