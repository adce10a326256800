#!/bin/sh
# Prepares <target>/python, the environment in which tests read output files with VTK and NumPy.
# Prints nothing, and does nothing if the environment is ready.
set -eu
root=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
venv=${CARGO_TARGET_DIR:-$root/target}/python
vtk=9.7.2

"$venv/bin/python" -c "
import numpy
from importlib.metadata import version
raise SystemExit(version('vtk') != '$vtk')" 2>/dev/null && exit 0

mkdir -p "$(dirname -- "$venv")"
python3 -m venv --clear "$venv"
# VTK's readers do not need its other dependencies, which are for plots.
"$venv/bin/python" -m pip --quiet --disable-pip-version-check install --no-deps "vtk==$vtk" numpy
