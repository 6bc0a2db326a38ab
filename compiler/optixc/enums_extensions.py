"""Enumerations of parts of OptiX that surround tracing: denoiser, displacement micromaps, clusters, cooperative vectors."""

from __future__ import annotations

from enum import IntEnum, IntFlag


class ClusterAccelBuildFlags(IntFlag):
    """OptiX's `OptixClusterAccelBuildFlags`."""

    NONE = 0
    PREFER_FAST_TRACE = 1
    PREFER_FAST_BUILD = 2
    ALLOW_OPACITY_MICROMAPS = 4


class ClusterAccelBuildMode(IntEnum):
    """OptiX's `OptixClusterAccelBuildMode`."""

    IMPLICIT_DESTINATIONS = 0
    EXPLICIT_DESTINATIONS = 1
    GET_SIZES = 2


class ClusterAccelBuildType(IntEnum):
    """OptiX's `OptixClusterAccelBuildType`."""

    GASES_FROM_CLUSTERS = 0x2545
    CLUSTERS_FROM_TRIANGLES = 0x2546
    TEMPLATES_FROM_TRIANGLES = 0x2547
    CLUSTERS_FROM_TEMPLATES = 0x2548
    TEMPLATES_FROM_GRIDS = 0x2549


class ClusterAccelClusterFlags(IntFlag):
    """OptiX's `OptixClusterAccelClusterFlags`."""

    NONE = 0
    ALLOW_DISABLE_OPACITY_MICROMAPS = 1


class ClusterAccelIndicesFormat(IntEnum):
    """OptiX's `OptixClusterAccelIndicesFormat`."""

    FORMAT_8BIT = 1
    FORMAT_16BIT = 2
    FORMAT_32BIT = 4


class ClusterAccelPrimitiveFlags(IntFlag):
    """OptiX's `OptixClusterAccelPrimitiveFlags`."""

    NONE = 0
    DISABLE_TRIANGLE_FACE_CULLING = 1
    REQUIRE_SINGLE_ANYHIT_CALL = 2
    DISABLE_ANYHIT = 4


class ClusterIDValues(IntEnum):
    """OptiX's `OptixClusterIDValues`."""

    INVALID = 0xFFFFFFFF


class CoopVecElemType(IntEnum):
    """OptiX's `OptixCoopVecElemType`."""

    UNKNOWN = 0x2A00
    FLOAT16 = 0x2A01
    FLOAT32 = 0x2A03
    UINT8 = 0x2A04
    INT8 = 0x2A05
    UINT32 = 0x2A08
    INT32 = 0x2A09
    FLOAT8_E4M3 = 0x2A0A
    FLOAT8_E5M2 = 0x2A0B


class CoopVecMatrixLayout(IntEnum):
    """OptiX's `OptixCoopVecMatrixLayout`."""

    ROW_MAJOR = 0x2A40
    COLUMN_MAJOR = 0x2A41
    INFERENCING_OPTIMAL = 0x2A42
    TRAINING_OPTIMAL = 0x2A43


class DenoiserAOVType(IntEnum):
    """OptiX's `OptixDenoiserAOVType`."""

    NONE = 0
    BEAUTY = 0x7000
    SPECULAR = 0x7001
    REFLECTION = 0x7002
    REFRACTION = 0x7003
    DIFFUSE = 0x7004


class DenoiserAlphaMode(IntEnum):
    """OptiX's `OptixDenoiserAlphaMode`."""

    COPY = 0
    DENOISE = 1


class DenoiserModelKind(IntEnum):
    """OptiX's `OptixDenoiserModelKind`."""

    AOV = 0x2324
    TEMPORAL_AOV = 0x2326
    UPSCALE2X = 0x2327
    TEMPORAL_UPSCALE2X = 0x2328
    LDR = 0x2322
    HDR = 0x2323
    TEMPORAL = 0x2325


class DisplacementMicromapArrayIndexingMode(IntEnum):
    """OptiX's `OptixDisplacementMicromapArrayIndexingMode`."""

    NONE = 0
    LINEAR = 1
    INDEXED = 2


class DisplacementMicromapBiasAndScaleFormat(IntEnum):
    """OptiX's `OptixDisplacementMicromapBiasAndScaleFormat`."""

    NONE = 0
    FLOAT2 = 0x2241
    HALF2 = 0x2242


class DisplacementMicromapDirectionFormat(IntEnum):
    """OptiX's `OptixDisplacementMicromapDirectionFormat`."""

    NONE = 0
    FLOAT3 = 0x2261
    HALF3 = 0x2262


class DisplacementMicromapFlags(IntFlag):
    """OptiX's `OptixDisplacementMicromapFlags`."""

    NONE = 0
    PREFER_FAST_TRACE = 1
    PREFER_FAST_BUILD = 2


class DisplacementMicromapFormat(IntEnum):
    """OptiX's `OptixDisplacementMicromapFormat`."""

    NONE = 0
    FORMAT_64_MICRO_TRIS_64_BYTES = 1
    FORMAT_256_MICRO_TRIS_128_BYTES = 2
    FORMAT_1024_MICRO_TRIS_128_BYTES = 3


class DisplacementMicromapTriangleFlags(IntFlag):
    """OptiX's `OptixDisplacementMicromapTriangleFlags`."""

    NONE = 0
    DECIMATE_EDGE_01 = 1
    DECIMATE_EDGE_12 = 2
    DECIMATE_EDGE_20 = 4


class PixelFormat(IntEnum):
    """OptiX's `OptixPixelFormat`."""

    HALF1 = 0x220A
    HALF2 = 0x2207
    HALF3 = 0x2201
    HALF4 = 0x2202
    FLOAT1 = 0x220B
    FLOAT2 = 0x2208
    FLOAT3 = 0x2203
    FLOAT4 = 0x2204
    UCHAR3 = 0x2205
    UCHAR4 = 0x2206
    INTERNAL_GUIDE_LAYER = 0x2209


class QueryFunctionTableOptions(IntEnum):
    """OptiX's `OptixQueryFunctionTableOptions`."""

    DUMMY = 0
