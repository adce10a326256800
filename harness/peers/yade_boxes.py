# Boxes that fall into a tray in Yade, with its polyhedra and their volumetric contact law. Writes the CPU time of the steps,
# the mean number of contacts, and the final speed and height. Run as `yade SCRIPT SETUP.json RESULT.json`.
import json
import sys
import time

from yade import polyhedra_utils

with open(sys.argv[1]) as file:
    setup = json.load(file)
rock = PolyhedraMat(density=2650, young=setup["stiffness"], poisson=0.3, frictionAngle=setup["friction"])
half = [edge / 2 for edge in setup["edges"]]
corners = [(i * half[0], j * half[1], k * half[2]) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
for block in setup["blocks"]:
    body = polyhedra_utils.polyhedra(rock, v=corners)
    body.state.pos = block["position"]
    body.state.ori = Quaternion(block["axis"], block["angle"])
    O.bodies.append(body)
for axis, at in ((0, 0), (0, setup["tray"][0]), (1, 0), (1, setup["tray"][1]), (2, 0)):
    O.bodies.append(utils.wall(at, axis=axis, material=rock))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Polyhedra_Aabb(), Bo1_Wall_Aabb()], verletDist=0.05 * min(setup["edges"])),
    InteractionLoop(
        [Ig2_Wall_Polyhedra_PolyhedraGeom(), Ig2_Polyhedra_Polyhedra_PolyhedraGeom()],
        [Ip2_PolyhedraMat_PolyhedraMat_PolyhedraPhys()],
        [Law2_PolyhedraGeom_PolyhedraPhys_Volumetric()],
    ),
    NewtonIntegrator(damping=0.3, gravity=(0, 0, -9.81)),
]
O.dt = setup["time_step"]
start, contacts = time.process_time(), 0
for _ in range(100):
    O.run(setup["steps"] // 100, True)
    contacts += sum(1 for i in O.interactions if i.isReal and i.geom.penetrationVolume > 0)
seconds = time.process_time() - start
with open(sys.argv[2], "w") as file:
    speed = max(O.bodies[n].state.vel.norm() for n in range(len(setup["blocks"])))
    lowest = min(O.bodies[n].state.pos[2] for n in range(len(setup["blocks"])))
    json.dump({"seconds": seconds, "contacts": contacts / 100, "speed": speed, "lowest": lowest}, file)
