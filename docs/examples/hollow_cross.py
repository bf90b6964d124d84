"""One quarter of a cross of twenty-four trapezoids, magnetised along its outline, that folds up."""

import magshell as ms

mm = 1e-3
CORNERS = {  # mm
    "end-x1": [(21, 0), (27, 0), (27, 11), (21, 5)],
    "shoulder-x1": [(16, 5), (21, 5), (27, 11), (16, 11)],
    "arm-x1": [(5, 5), (16, 5), (16, 11), (11, 11)],
    "arm-x2": [(5, 5), (11, 11), (11, 16), (5, 16)],
    "shoulder-x2": [(5, 16), (11, 16), (11, 27), (5, 21)],
    "end-x2": [(0, 21), (5, 21), (11, 27), (0, 27)],
}
DIRECTIONS = {
    "end-x1": (0, -1, 0),
    "shoulder-x1": (-1, 0, 0),
    "arm-x1": (1, 0, 0),
    "arm-x2": (0, 1, 0),
    "shoulder-x2": (0, -1, 0),
    "end-x2": (-1, 0, 0),
}
quarter = ms.mesh.blocks({name: [(x * mm, y * mm) for x, y in four] for name, four in CORNERS.items()}, (6, 6))
quarter = quarter.select_edges("mirror-x1", x1=0).select_edges("mirror-x2", x2=0)
quarter = quarter.select_nodes("A", x1=24 * mm, x2=0).select_nodes("G", x1=0, x2=24 * mm)

rubber = ms.MicropolarNeoHookean(shear_modulus=303e3, lame_lambda=7300e3, coupling_modulus=30.3e3, length_scale=4.1e-5)
remanence = ms.remanence.by_group(
    {name: ms.remanence.constant([102e-3 * x for x in direction]) for name, direction in DIRECTIONS.items()}
)
model = ms.Model(
    ms.Shell(quarter, 0.41 * mm, rubber, remanence),
    supports=[
        ms.SymmetryPlane("mirror-x1", (1, 0, 0)),
        ms.SymmetryPlane("mirror-x2", (0, 1, 0)),
        ms.Prescribe("A", "u", 3, 0.0),
        ms.Prescribe("G", "u", 3, 0.0),
    ],
    field=ms.UniformField([0, 0, -200e-3], stops=[10e-3, 50e-3, 100e-3, 200e-3]),
    probes={"A": (24 * mm, 0, 0), "C": (27 * mm, 11 * mm, 0), "E": (5 * mm, 5 * mm, 0), "G": (0, 24 * mm, 0)},
)
path = ms.solve(model)
print(f"the corners rise: C {1e3 * path.probe('C').u3[-1]:.2f} mm, E {1e3 * path.probe('E').u3[-1]:.2f} mm")
