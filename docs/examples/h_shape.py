"""One quarter of an H of fifteen blocks that stands up on the ends of its legs."""

import magshell as ms

mm = 1e-3
blocks = {
    "centre": [(0, 0), (3 * mm, 0), (3 * mm, 3 * mm), (0, 3 * mm)],
    "bar": [(3 * mm, 0), (15 * mm, 0), (15 * mm, 3 * mm), (3 * mm, 3 * mm)],
    "junction": [(15 * mm, 0), (21 * mm, 0), (21 * mm, 3 * mm), (15 * mm, 3 * mm)],
    "leg": [(15 * mm, 3 * mm), (21 * mm, 3 * mm), (21 * mm, 15 * mm), (15 * mm, 15 * mm)],
}
quarter = ms.mesh.blocks(blocks, {"centre": (2, 2), "bar": (8, 2), "junction": (4, 2), "leg": (4, 8)})
quarter = quarter.select_edges("mirror-x1", x1=0).select_edges("mirror-x2", x2=0)
quarter = quarter.select_nodes("D", x1=21 * mm, x2=15 * mm)

rubber = ms.MicropolarNeoHookean(shear_modulus=135e3, lame_lambda=3250e3, coupling_modulus=13.5e3, length_scale=9e-5)
remanence = ms.remanence.by_group(
    {"bar": ms.remanence.constant([94e-3, 0, 0]), "leg": ms.remanence.constant([0, 94e-3, 0])}
)
model = ms.Model(
    ms.Shell(quarter, 0.9 * mm, rubber, remanence),
    supports=[
        ms.SymmetryPlane("mirror-x1", (1, 0, 0)),
        ms.SymmetryPlane("mirror-x2", (0, 1, 0)),
        ms.Prescribe("D", "u", 3, 0.0),
    ],
    field=ms.UniformField([0, 0, -50e-3], stops=[2e-3, 5e-3, 15e-3, 50e-3]),
    probes={"A": (0, 0, 0), "A'": (0, 3 * mm, 0), "C": (21 * mm, 0, 0), "D": (21 * mm, 15 * mm, 0)},
)
path = ms.solve(model)
print(f"the middle of the bar rises {1e3 * path.probe('A').u3[-1]:.2f} mm above the ends of the legs")
