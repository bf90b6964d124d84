"""Problem files that work, with a field or with loads, and a way to change one thing in them."""

from __future__ import annotations


def changed(text: str, *changes: tuple[str, str]) -> str:
    """A problem file with pieces (old, new) exchanged, each of which stands in it exactly once."""
    for old, new in changes:
        assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times in the file; a change needs one place"
        text = text.replace(old, new)
    return text


def with_mesh(text: str, mesh: str) -> str:
    """A problem file with another table `mesh`."""
    return changed(text, (text[text.index("[mesh]") : text.index("[shell]")], mesh))


STRIP = """
[mesh]
generator = "rectangle"
length = "20 mm"
width = "5 mm"
elements = [4, 1]

[mesh.edge_groups]
far = { x1 = "20 mm" }

[shell]
thickness = "1 mm"

[material]
law = "micropolar-neo-hookean"
shear_modulus = "303 kPa"
lame_lambda = "7300 kPa"
coupling_modulus = "0.1 mu"
length_scale = "0.1 h"

[[remanence]]
kind = "constant"
vector = ["143 mT", 0, 0]

[field]
flux_density = [0, 0, "2 mT"]
stops = ["1 mT", "2 mT"]

[[supports]]
kind = "clamp"
group = "left"

[probes]
tip = ["20 mm", 0, 0]
"""

BLOCKS = with_mesh(
    STRIP,
    """[mesh]
generator = "blocks"
elements = [2, 1]

[mesh.blocks.one]
corners = [[0, 0], ["10 mm", 0], ["10 mm", "5 mm"], [0, "5 mm"]]

[mesh.blocks.two]
corners = [["10 mm", 0], ["20 mm", 0], ["20 mm", "5 mm"], ["10 mm", "5 mm"]]

[mesh.edge_groups]
left = { x1 = 0 }

""",
)

PUMP = changed(
    with_mesh(
        STRIP,
        """[mesh]
generator = "cylinder"
radius = "20 mm"
length = "10 mm"
elements = [6, 1]
angle = ["0 deg", "90 deg"]

""",
    ),
    ('"left"', '"start"'),
)

PROFILE = changed(
    with_mesh(
        STRIP,
        """[mesh]
generator = "profile"
length = "10 mm"
elements = [2, 2]

[mesh.points]
low = [0, 0]
knee = ["20 mm", 0]
high = ["20 mm", "8 mm"]

[mesh.walls]
post = { between = ["low", "knee"], elements = 4 }
arm = { between = ["knee", "high"] }

""",
    ),
    ('group = "left"', 'group = "low"'),
)
MIURA = changed(
    with_mesh(
        STRIP,
        """[mesh]
generator = "miura"
sides = ["10 mm", "8 mm"]
sector = "60 deg"
fold = "30 deg"
cells = [1, 1]
elements = [1, 1]

""",
    ),
    ('[probes]\ntip = ["20 mm", 0, 0]\n', ""),
)
JOINTED = changed(
    with_mesh(
        STRIP,
        """[mesh]
generator = "profile"
length = "5 mm"
axis = [0, 1, 0]
first = [1, 0, 0]
elements = [2, 1]

[mesh.points]
left = [0, 0]
fold = ["10 mm", 0]
right = ["20 mm", 0]

[mesh.walls]
one = { between = ["left", "fold"] }
two = { between = ["fold", "right"] }

[[rigid]]
group = "right"
name = "magnet"
moment = ["0.5 mA m^2", 0, 0]
mass = "1 g"

[[hinges]]
group = "fold"
stiffness = "20 mN/rad"

""",
    ),
    (
        '[[supports]]\nkind = "clamp"\ngroup = "left"\n',
        """[[supports]]
kind = "turn"
group = "left"
axis = [0, 1, 0]
angle = "10 deg"

[[springs]]
kind = "translation"
group = "magnet"
stiffness = "1 N/m"

[[loads]]
kind = "gravity"
group = "magnet"
acceleration = [0, 0, "-9.81 m/s^2"]

""",
    ),
)
_MAGNETIC = STRIP[STRIP.index("[[remanence]]") : STRIP.index("[[supports]]")]
LOADED = changed(
    STRIP,
    (
        _MAGNETIC,
        """[[loads]]
kind = "force"
group = "far"
total = [0, 0, "2 mN"]

[[loads]]
kind = "moment"
group = "right"
total = [0, "0.01 N mm", 0]

""",
    ),
)
