"""A problem file with everything that regions and layers can say."""

REGIONS = """
title = "Two halves"

[mesh]
generator = "rectangle"
length = "20 mm"
width = "5 mm"
elements = [4, 1]

[mesh.element_groups]
inner = { x1 = [0, "10 mm"] }
outer = { x1 = ["10 mm", "20 mm"] }
ends = { groups = ["outer"], x1 = ["15 mm", "20 mm"] }

[shell]
thickness = "1 mm"
density = "1.1 g/cm^3"
offset = "bottom"

[material]
law = "micropolar-neo-hookean"
shear_modulus = "303 kPa"
lame_lambda = "7300 kPa"
coupling_modulus = "303 kPa"
length_scale = "10 um"

[[remanence]]
kind = "constant"
vector = ["143 mT", 0, 0]

[[regions]]
group = "outer"
density = "2 g/cm^3"
offset = "0.1 mm"
levels = 3

[[regions.layers]]
thickness = "0.4 mm"
density = "1 g/cm^3"
material.law = "micropolar-neo-hookean"
material.shear_modulus = "60 kPa"
material.lame_lambda = 0
material.coupling_modulus = "60 kPa"
material.length_scale = "4 um"

[[regions.layers]]
thickness = { along = [1, 0, 0], positions = ["10 mm", "20 mm"], values = ["0.6 mm", "0.3 mm"] }

[regions.layers.material]
law = "micropolar-mooney-rivlin"
shear_modulus = "100 kPa"
lame_lambda = "1 MPa"
coupling_modulus = "100 kPa"
length_scale = "6 um"

[[regions.layers.remanence]]
kind = "constant"
vector = [0, 0, "50 mT"]

[field]
flux_density = ["1 mT", 0, "2 mT"]

[[loads]]
kind = "gravity"
acceleration = [0, 0, "-9.81 m/s^2"]

[[supports]]
kind = "clamp"
group = "left"

[probes]
tip = ["20 mm", 0, 0]
"""
