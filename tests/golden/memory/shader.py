"""Arrays of structs, nested structs, atomics and textures."""

import optixc as ox
from optixc import float2, float3, float4, half4, int32, uint32


@ox.struct
class Photon:
    position: float3
    power: float3
    flags: ox.uint8


@ox.struct
class Store:
    photons: ox.Array[Photon]
    count: ox.Array[uint32]


@ox.struct
class Params:
    store: Store
    sums: ox.Array[ox.float32]
    halves: ox.Array2[half4]
    volume: ox.Array3[ox.uint16]
    image: ox.Texture


params = ox.launch_params(Params)


@ox.device
def next_float(state: Photon) -> float:
    state.position.x += 0.5
    return state.position.x


@ox.program
def __raygen__store():
    i = ox.get_launch_index()
    slot = ox.atomic_add(params.store.count, 0, 1)
    photon = Photon(float3(1.0), float3(0.5), 3)
    uv = float2(next_float(photon), next_float(photon))
    if int32(slot) < params.store.photons.shape[0]:
        params.store.photons[slot] = photon
        params.store.photons[slot].flags = params.store.photons[0].flags + 1
        params.store.photons[slot].power.y = 2.0
    ox.atomic_max(params.sums, slot, uv.x)
    texel = ox.tex2d(params.image, uv.x, uv.y)
    params.halves[i.y, i.x] = half4(texel)
    params.volume[i.z, i.y, i.x] = uint32(texel.x)
    copied = ox.copy(photon)
    copied.power = float4(params.halves[0, 0]).xyz
    params.store.photons[0] = copied


@ox.program
def __raygen__items():
    """Items that a helper changes, by indices that differ and that do not; parts of storage vectors; shifts of literals."""
    i = ox.get_launch_index().x
    photons = ox.FixedArray[Photon, 2]()
    grid = ox.FixedArray[ox.FixedArray[uint32, 2], 4]()
    grid[i & 3][i >> 2 & 1] = 1 << (i & 31)
    x = next_float(photons[i & 1]) + next_float(photons[0])
    photons[1].flags = grid[2][i & 1] & ~4
    params.halves[0, i].y = x
    params.sums[i] = photons[i & 1].position.x
