"""Problem files with every kind of remanence that needs no file, each with every key."""

from __future__ import annotations

from problem_files import BLOCKS, changed

REMANENCE = '[[remanence]]\nkind = "constant"\nvector = ["143 mT", 0, 0]\n'
FIELDS = changed(
    BLOCKS,
    ("[mesh.edge_groups]", "[mesh.edge_groups]\nfront = { x2 = 0 }"),
    (
        REMANENCE,
        """[[remanence]]
kind = "profile"
group = "one"
along = [1, 0, 0]
positions = [0, "5 mm", "10 mm"]
magnitude = ["50 mT", "-20 mT", "50 mT"]
direction = [1, 0, 0]
angle = ["45 deg", "0.5 rad", "405 deg"]
towards = [0, 0, 1]
origin = ["1 mm", 0, 0]

[[remanence]]
kind = "along-curve"
group = "two"
curve = "front"
magnitude = "80 mT"
towards = [1, 1, 0]
""",
    ),
)
SURFACES = changed(
    BLOCKS,
    (
        REMANENCE,
        """[[remanence]]
kind = "radial"
group = "one"
magnitude = "0.1 T"
axis = [0, 0, 2]
through = ["20 mm", "1 mm", 0]
inward = true

[[remanence]]
kind = "tangential"
group = "two"
magnitude = "80 mT"
direction = [1, 1, 1]
""",
    ),
)
TEMPLATES = changed(
    BLOCKS,
    (
        REMANENCE,
        """[[remanence]]
kind = "rolled"
group = "one"
magnitude = "60 mT"
direction = [0, 0, 1]
radius = "3 mm"
through = [0, 0, 0]
along = [1, 0, 0]
towards = [0, 0, 1]

[[remanence]]
kind = "folded"
group = "two"
magnitude = "60 mT"
direction = [0, 0, 1]

[[remanence.folds]]
through = ["10 mm", 0, 0]
along = [1, 0, 0]
towards = [0, 0, 1]
angle = "90 deg"
radius = "1 mm"

[[remanence.folds]]
through = ["15 mm", 0, 0]
along = [1, 0, 0]
towards = [0, 0, -1]
angle = "90 deg"
""",
    ),
)
