#!/usr/bin/env bash
# Runs a scene, by default plucking.toml; all arguments go to `riprap run`.
set -euo pipefail
root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/harness/environment.sh"

"$root/harness/setup.sh"
[ $# -gt 0 ] || set -- "$root/harness/scenes/plucking.toml"
exec cargo run --release --manifest-path "$root/Cargo.toml" -p riprap-harness -- run "$@"
