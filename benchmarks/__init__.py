"""Rays per second, launch overhead, compile time and memory of optixc beside hand-written C++ on Embree and beside other systems."""
