"""A problem file with every kind of load, each with every key."""

from __future__ import annotations

from problem_files import BLOCKS, changed

_MAGNETIC = BLOCKS[BLOCKS.index("[[remanence]]") : BLOCKS.index("[[supports]]")]
EVERY_LOAD = changed(
    BLOCKS,
    ("left = { x1 = 0 }", 'left = { x1 = 0 }\nfar = { x1 = "20 mm" }'),
    ('thickness = "1 mm"', 'thickness = "1 mm"\ndensity = "1.2 g/cm^3"'),
    (
        _MAGNETIC,
        """[[loads]]
kind = "force"
group = "far"
total = [0, 0, "2 mN"]
follower = true
history = [0, 1]

[[loads]]
kind = "moment"
group = "left"
total = [0, "0.01 N mm", 0]
follower = true
history = [0.5, 1]

[[loads]]
kind = "traction"
group = "two"
traction = [0, 0, "5 Pa"]
history = [0, -1]

[[loads]]
kind = "pressure"
group = "one"
pressure = "-8 Pa"
history = [0, 1]

[[loads]]
kind = "gravity"
acceleration = [0, 0, "-9.81 m/s^2"]
group = "two"
history = [1, 1]

""",
    ),
)
