"""Flat outlines: from DXF, SVG and CSV files, and polygons; meshed by gmsh."""
