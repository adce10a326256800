"""A dam break in a box with PySPH: its standard weakly compressible scheme with the kernel, the neighbours, the speed of sound
and the time step of riprap's scene. Prints the position of the front, m, and the numbers of particles.

    pysph_dam.py SETUP.json [options of PySPH]
"""
import json
import sys

import numpy
from pysph.base.kernels import WendlandQuintic
from pysph.base.utils import get_particle_array_wcsph
from pysph.solver.application import Application
from pysph.sph.scheme import WCSPHScheme

with open(sys.argv.pop(1)) as file:
    setup = json.load(file)
DX, HDX, C0, DT = (setup[key] for key in ("spacing", "smoothing", "sound_speed", "time_step"))
TANK, COLUMN = setup["tank"], setup["column"]
LAYERS = round(2 * HDX)


def lattice(low, high):
    """Centres of the cells of a box whose corners are multiples of the spacing."""
    axes = [DX * (numpy.arange(round(a / DX), round(b / DX)) + 0.5) for a, b in zip(low, high)]
    return [x.ravel() for x in numpy.meshgrid(*axes, indexing="ij")]


class Dam(Application):
    def create_scheme(self):
        scheme = WCSPHScheme(["fluid"], ["wall"], dim=3, rho0=1000, c0=C0, h0=HDX * DX, hdx=HDX, gz=-9.81)
        scheme.configure_solver(kernel=WendlandQuintic(dim=3), dt=DT, tf=1e9, adaptive_timestep=False)
        return scheme

    def create_particles(self):
        thick = LAYERS * DX
        x, y, z = lattice([-thick, -thick, -thick], [TANK[0] + thick, TANK[1] + thick, TANK[2]])
        outside = (x < 0) | (x > TANK[0]) | (y < 0) | (y > TANK[1]) | (z < 0)
        wall = [x[outside], y[outside], z[outside]]
        made = []
        for name, (x, y, z) in (("fluid", lattice([0, 0, 0], COLUMN)), ("wall", wall)):
            mass = 1000 * DX**3
            made.append(get_particle_array_wcsph(name=name, x=x, y=y, z=z, m=mass, h=HDX * DX, rho=1000, rad_s=DX / 2))
        self.scheme.setup_properties(made)
        return made


dam = Dam()
dam.run()
fluid, wall = dam.particles
print(json.dumps({"front": float(fluid.x.max()), "particles": len(fluid.x), "boundary_particles": len(wall.x)}))
