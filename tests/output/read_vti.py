"""Reads a .vti, or the last file of a .pvd, with VTK and prints what it holds as JSON."""

import json
import os
import sys
import xml.etree.ElementTree as ElementTree

from vtkmodules.vtkIOXML import vtkXMLImageDataReader

path = sys.argv[1]
entries = []
if path.endswith(".pvd"):
    for entry in ElementTree.parse(path).iter("DataSet"):
        entries.append([float(entry.get("timestep")), entry.get("file")])
    path = os.path.join(os.path.dirname(path), entries[-1][1])

reader = vtkXMLImageDataReader()
if not reader.CanReadFile(path):
    sys.exit(f"VTK cannot read {path}")
reader.SetFileName(path)
reader.Update()
image = reader.GetOutput()
cells = image.GetCellData()
arrays = {}
for number in range(cells.GetNumberOfArrays()):
    array = cells.GetArray(number)
    components = array.GetNumberOfComponents()
    tuples = [array.GetTuple(cell) for cell in range(array.GetNumberOfTuples())]
    arrays[array.GetName()] = {
        "components": components,
        "tuples": len(tuples),
        "sums": [sum(values) for values in zip(*tuples)],
        "first": tuples[0],
        "second": tuples[1],
        "last": tuples[-1],
    }
print(
    json.dumps(
        {
            "entries": entries,
            "points": image.GetDimensions(),
            "origin": image.GetOrigin(),
            "spacing": image.GetSpacing(),
            "arrays": arrays,
        }
    )
)
