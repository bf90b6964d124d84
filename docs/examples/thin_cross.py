"""One quarter of a cross of nine blocks: one pair of arms rises, the other stands."""

import magshell as ms

mm = 1e-3
blocks = {
    "centre": [(0, 0), (3 * mm, 0), (3 * mm, 3 * mm), (0, 3 * mm)],
    "arm-x1": [(3 * mm, 0), (15 * mm, 0), (15 * mm, 3 * mm), (3 * mm, 3 * mm)],
    "arm-x2": [(0, 3 * mm), (3 * mm, 3 * mm), (3 * mm, 15 * mm), (0, 15 * mm)],
}
quarter = ms.mesh.blocks(blocks, {"centre": (3, 3), "arm-x1": (12, 3), "arm-x2": (3, 12)})
quarter = quarter.select_edges("mirror-x1", x1=0).select_edges("mirror-x2", x2=0)
quarter = quarter.select_nodes("D", x1=0, x2=15 * mm)

rubber = ms.MicropolarNeoHookean(shear_modulus=135e3, lame_lambda=3250e3, coupling_modulus=13.5e3, length_scale=9e-5)
remanence = ms.remanence.by_group(
    {"arm-x1": ms.remanence.constant([94e-3, 0, 0]), "arm-x2": ms.remanence.constant([0, -94e-3, 0])}
)
model = ms.Model(
    ms.Shell(quarter, 0.9 * mm, rubber, remanence),
    supports=[
        ms.SymmetryPlane("mirror-x1", (1, 0, 0)),
        ms.SymmetryPlane("mirror-x2", (0, 1, 0)),
        ms.Prescribe("D", "u", 3, 0.0),
    ],
    field=ms.UniformField([0, 0, 40e-3], stops=[2e-3, 5e-3, 10e-3, 20e-3, 30e-3, 40e-3]),
    probes={"A": (15 * mm, 0, 0), "A'": (15 * mm, 3 * mm, 0), "C": (0, 0, 0), "D": (0, 15 * mm, 0)},
)
path = ms.solve(model)
print(f"A rises {1e3 * path.probe('A').u3[-1]:.2f} mm above D")
