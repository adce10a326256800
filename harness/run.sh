#!/usr/bin/env bash
# Runs a scene, the block plucked from its bed if none is named; all else goes to `riprap run`.
set -euo pipefail
root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
# Mesa would ask a display which GPU to prefer, and complain where there is none.
export NODEVICE_SELECT=1

"$root/harness/setup.sh"
[ $# -gt 0 ] || set -- "$root/harness/scenes/plucking.toml"
exec cargo run --release --manifest-path "$root/Cargo.toml" -p riprap-harness -- run "$@"
