"""Shader functions to import: random numbers, sampling, frames, BSDFs, cameras, lights, textures, tone mapping.

Each file is restricted Python: `from optixc.stdlib.sampling import cosine_hemisphere` works in a shader and in ordinary Python.
Directions point away from the surface and are unit vectors, angles are radians, `u` is a point of the unit square.
"""
