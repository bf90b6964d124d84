"""One of twelve arms, clamped near the pole of a sphere, that opens in a field along the axis."""

import math

import magshell as ms

radius = 12e-3 / (math.pi / 6)  # 12 mm of equator span 30 degrees
arm = ms.mesh.sphere_patch(radius, polar=(15, 165), azimuth=(-15, 15), elements=(30, 6))
rubber = ms.MicropolarNeoHookean(shear_modulus=135e3, lame_lambda=3250e3, coupling_modulus=13.5e3, length_scale=9e-5)
model = ms.Model(
    ms.Shell(arm, 0.9e-3, rubber, remanence=ms.remanence.meridional(94e-3)),
    supports=[ms.Clamp("top")],
    field=ms.UniformField([0, 0, 10e-3], stops=[1e-3, 2e-3, 4e-3, 6.8e-3, 10e-3]),
    probes={"B": (radius, 0, 0)},
)
path = ms.solve(model)
print(f"the equator of the arm rises {1e3 * path.probe('B').u3[-1]:.2f} mm")
