"""An observer that writes the particles for ParaView: a .vtu a frame, and a .pvd that knows their times.

    python examples/python/write_vtk.py [FOLDER]
"""
import pathlib
import sys

import dreampm as dm

SCENE = dm.Scene(
    space={"min": [0, 0, 0], "max": [0.6, 0.3, 0.1], "spacing": 0.0125},
    time={"fps": 25},
    materials={"water": {"type": "newtonian", "preset": "water"}},
    bodies={"dam": {"material": "water", "shape": {"box": {"min": [0, 0, 0], "max": [0.2, 0.2, 0.1]}}}})


class VtkWriter:
    """Writes the particles of a material where a frame ends: sim.on_frame(VtkWriter(sim, "water", folder))."""

    def __init__(self, simulation, material, folder):
        self.simulation, self.material, self.folder = simulation, material, pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.frames = []

    def __call__(self, event):
        name = f"{self.material}_{event.frame:06d}.vtu"
        (self.folder / name).write_text(self.text())
        self.frames.append(f'<DataSet timestep="{event.time!r}" file="{name}"/>')
        (self.folder / f"{self.material}.pvd").write_text(
            '<VTKFile type="Collection" version="1.0"><Collection>\n' + "\n".join(self.frames) +
            "\n</Collection></VTKFile>\n")

    def text(self):
        particles = self.simulation.particles[self.material]
        n = len(particles)

        def array(name, kind, values, components=1):
            text = "\n".join(" ".join(map(str, row)) for row in values.reshape(n, components).tolist())
            return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">\n'
                    f'{text}\n</DataArray>\n')

        vertices = "\n".join(map(str, range(n)))
        offsets = "\n".join(map(str, range(1, n + 1)))
        types = "\n".join("1" for _ in range(n))  # VTK_VERTEX
        return ('<VTKFile type="UnstructuredGrid" version="1.0"><UnstructuredGrid>\n'
                f'<Piece NumberOfPoints="{n}" NumberOfCells="{n}">\n'
                '<Points>\n' + array("position", "Float32", particles.position, 3) + '</Points>\n'
                '<PointData Vectors="velocity">\n' + array("velocity", "Float32", particles.velocity, 3) +
                array("J", "Float32", particles.J) + array("id", "UInt32", particles.id) + '</PointData>\n'
                '<Cells>\n'
                f'<DataArray type="Int32" Name="connectivity" format="ascii">\n{vertices}\n</DataArray>\n'
                f'<DataArray type="Int32" Name="offsets" format="ascii">\n{offsets}\n</DataArray>\n'
                f'<DataArray type="UInt8" Name="types" format="ascii">\n{types}\n</DataArray>\n'
                '</Cells>\n</Piece>\n</UnstructuredGrid></VTKFile>\n')


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "vtk"
    sim = dm.Simulation(SCENE)
    writer = VtkWriter(sim, "water", folder)
    sim.on_frame(writer)
    sim.advance_frames(8)
    print(f"{len(writer.frames)} frames in {folder}/")


if __name__ == "__main__":
    main()
