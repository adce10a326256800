"""Reads a .vtu or a .vtp, or the last file of a .pvd, with VTK and prints what it holds as JSON."""

import json
import os
import sys
import xml.etree.ElementTree as ElementTree

from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

path = sys.argv[1]
entries = []
if path.endswith(".pvd"):
    for entry in ElementTree.parse(path).iter("DataSet"):
        entries.append([float(entry.get("timestep")), entry.get("file")])
    path = os.path.join(os.path.dirname(path), entries[-1][1])

solid = path.endswith(".vtu")
reader = vtkXMLUnstructuredGridReader() if solid else vtkXMLPolyDataReader()
if not reader.CanReadFile(path):
    sys.exit(f"VTK cannot read {path}")
reader.SetFileName(path)
reader.Update()
data = reader.GetOutput()
surface = not solid and data.GetNumberOfPolys() > 0
attributes = data.GetCellData() if solid or surface else data.GetPointData()
arrays = {}
for number in range(attributes.GetNumberOfArrays()):
    array = attributes.GetArray(number)
    count = array.GetNumberOfTuples()
    values = [array.GetTuple(item) for item in range(count)]
    # JSON has no NaN.
    arrays[array.GetName()] = [[None if x != x else x for x in value] for value in values]
cells = []
if solid:
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(data)
    sizes.Update()
    volumes = sizes.GetOutput().GetCellData().GetArray("Volume")
    for number in range(data.GetNumberOfCells()):
        cell = data.GetCell(number)
        cells.append(
            {
                "type": data.GetCellType(number),
                "points": cell.GetNumberOfPoints(),
                "faces": cell.GetNumberOfFaces(),
                "bounds": list(cell.GetBounds()),
                "volume": volumes.GetTuple(number)[0],
            }
        )
print(
    json.dumps(
        {
            "entries": entries,
            "points": [data.GetPoint(item) for item in range(data.GetNumberOfPoints())],
            "verts": 0 if solid else data.GetNumberOfVerts(),
            "cells": cells,
            "arrays": arrays,
        }
    )
)
