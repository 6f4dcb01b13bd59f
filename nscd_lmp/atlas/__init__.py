"""Where each method fails: maps over the two parameters that break it."""

from nscd_lmp.atlas.atlas import Map, find_maps, make

__all__ = ["Map", "find_maps", "make"]
