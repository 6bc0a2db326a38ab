"""Words of a payload that are not carried: never read, read in another trace only, handed from program to program, not brought back."""

import optixc as ox
from optixc import float3, uint32


@ox.struct
class Params:
    out: ox.Array[float3]
    scene: ox.Traversable


@ox.payload
class Path:
    color: float3
    weight: float
    seen: uint32
    note: float3


@ox.payload
class Count:
    hits: uint32 = ox.payload_word(caller="r", ah="rw", ms="w")
    first: uint32 = ox.payload_word(caller="w", ah="r")
    last: float = ox.payload_word(ah="w", ms="r")


params = ox.launch_params(Params)


@ox.device
def shade(path: Path, by: float):
    path.color = path.color * by + path.weight
    path.note = float3(by)


@ox.program
def __raygen__main():
    i = ox.get_launch_index().x
    path = Path(params.out[i], 1.0, 0, float3(float(i)))
    ox.trace(params.scene, float3(0.0), float3(0.0, 0.0, 1.0), payload=path)
    path.weight = 0.5
    ox.trace(params.scene, path.color, float3(0.0, 1.0, 0.0), payload=path)
    count = Count(0, i, 0.0)
    ox.trace(params.scene, float3(0.0), float3(1.0, 0.0, 0.0), sbt_offset=1, miss_sbt_index=1, payload=count)
    params.out[i] = path.color * float(count.hits)


@ox.program
def __closesthit__next(path: Path):
    shade(path, ox.get_ray_tmax())
    path.seen += 1
    deeper = Path(path.color, 0.3 * path.weight, path.seen, path.note)
    if path.weight > 0.1:
        ox.trace(params.scene, float3(0.0), float3(0.0, 0.0, 1.0), payload=deeper)
    path.color = deeper.color


@ox.program
def __miss__sky(path: Path):
    path.color += float3(1.0)
    path.seen = 0


@ox.program
def __anyhit__count(count: Count):
    count.hits = count.first + 1
    count.last = ox.get_ray_tmax()


@ox.program
def __miss__count(count: Count):
    count.hits = 7 if count.last > 1.0 else 8
