"""One quarter of a tube, clamped at its ends, that a field across it squeezes in the middle."""

import math

import magshell as ms

radius = 24 * 6e-3 / (2 * math.pi)  # 24 blocks of 6 mm around
tube = ms.mesh.cylinder(radius, 60e-3, (24, 20), angle=(-90, 90), axis=(0, 1, 0), zero=(1, 0, 0))
rubber = ms.MicropolarNeoHookean(shear_modulus=135e3, lame_lambda=3250e3, coupling_modulus=13.5e3, length_scale=9e-5)
remanence = ms.remanence.circumferential(94e-3, axis=(0, 1, 0), towards=(0, 0, 1))
model = ms.Model(
    ms.Shell(tube, 0.9e-3, rubber, remanence),
    supports=[
        ms.Clamp("end"),
        ms.SymmetryPlane("start", (0, 1, 0)),
        ms.SymmetryPlane("angle-start", (1, 0, 0)),
        ms.SymmetryPlane("angle-stop", (1, 0, 0)),
    ],
    field=ms.UniformField([0, 0, 150e-3], stops=[20e-3, 50e-3, 100e-3, 150e-3]),
    probes={"A": (0, 0, radius), "B": (radius, 0, 0), "C": (radius / math.sqrt(2), 0, radius / math.sqrt(2))},
)
path = ms.solve(model)
print(f"the side of the tube moves inwards by {-1e3 * path.probe('B').u1[-1]:.2f} mm")
