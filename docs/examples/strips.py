"""Four strips, clamped at one end, in a field across them."""

import magshell as ms

SIZES = {  # length, thickness (m), elements along
    "strip-10": (11e-3, 1.1e-3, 10),
    "strip-17": (19.2e-3, 1.1e-3, 15),
    "strip-20": (17.2e-3, 0.84e-3, 30),
    "strip-41": (17.2e-3, 0.42e-3, 40),
}

field = ms.UniformField([0, 0, 50e-3], stops=[1e-3, 2e-3, 3e-3, 5e-3, 10e-3, 15e-3, 20e-3, 50e-3])
paths = {}
for name, (length, thickness, along) in SIZES.items():
    strip = ms.mesh.rectangle(length, 5e-3, (along, 2))
    rubber = ms.MicropolarNeoHookean(
        shear_modulus=303e3, lame_lambda=7300e3, coupling_modulus=30.3e3, length_scale=thickness / 10
    )
    shell = ms.Shell(strip, thickness, rubber, remanence=ms.remanence.constant([143e-3, 0, 0]))
    model = ms.Model(shell, [ms.Clamp("left")], field, probes={"tip": (length, 2.5e-3, 0)})
    paths[name] = ms.solve(model)
    print(f"{name}: u3/L = {paths[name].probe('tip').u3[-1] / length:.4f}")
