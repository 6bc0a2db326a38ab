"""What describes a scene to the runtime: OptiX's enumerations for builds, instances, geometry, rays and formats, with OptiX's values.

A member is named without the prefix that all members of its enumeration share.
"""

from __future__ import annotations

from enum import IntEnum, IntFlag


class AccelPropertyType(IntEnum):
    """OptiX's `OptixAccelPropertyType`."""

    COMPACTED_SIZE = 0x2181
    AABBS = 0x2182


class BuildFlags(IntFlag):
    """OptiX's `OptixBuildFlags`."""

    NONE = 0
    ALLOW_UPDATE = 1
    ALLOW_COMPACTION = 2
    PREFER_FAST_TRACE = 4
    PREFER_FAST_BUILD = 8
    ALLOW_RANDOM_VERTEX_ACCESS = 16
    ALLOW_RANDOM_INSTANCE_ACCESS = 32
    ALLOW_OPACITY_MICROMAP_UPDATE = 64
    ALLOW_DISABLE_OPACITY_MICROMAPS = 128


class BuildInputType(IntEnum):
    """OptiX's `OptixBuildInputType`."""

    TRIANGLES = 0x2141
    CUSTOM_PRIMITIVES = 0x2142
    INSTANCES = 0x2143
    INSTANCE_POINTERS = 0x2144
    CURVES = 0x2145
    SPHERES = 0x2146


class BuildOperation(IntEnum):
    """OptiX's `OptixBuildOperation`."""

    BUILD = 0x2161
    UPDATE = 0x2162


class CurveEndcapFlags(IntFlag):
    """OptiX's `OptixCurveEndcapFlags`."""

    DEFAULT = 0
    ON = 1


class GeometryFlags(IntFlag):
    """OptiX's `OptixGeometryFlags`."""

    NONE = 0
    DISABLE_ANYHIT = 1
    REQUIRE_SINGLE_ANYHIT_CALL = 2
    DISABLE_TRIANGLE_FACE_CULLING = 4


class HitKind(IntEnum):
    """OptiX's `OptixHitKind`; the longer names are those of OptiX."""

    FRONT_FACE = 0xFE
    BACK_FACE = 0xFF
    TRIANGLE_FRONT_FACE = FRONT_FACE
    TRIANGLE_BACK_FACE = BACK_FACE


class IndicesFormat(IntEnum):
    """OptiX's `OptixIndicesFormat`."""

    NONE = 0
    UNSIGNED_BYTE3 = 0x2101
    UNSIGNED_SHORT3 = 0x2102
    UNSIGNED_INT3 = 0x2103


class InstanceFlags(IntFlag):
    """OptiX's `OptixInstanceFlags`."""

    NONE = 0
    DISABLE_TRIANGLE_FACE_CULLING = 1
    FLIP_TRIANGLE_FACING = 2
    DISABLE_ANYHIT = 4
    ENFORCE_ANYHIT = 8
    FORCE_OPACITY_MICROMAP_2_STATE = 16
    DISABLE_OPACITY_MICROMAPS = 32


class MotionFlags(IntFlag):
    """OptiX's `OptixMotionFlags`."""

    NONE = 0
    START_VANISH = 1
    END_VANISH = 2


class OpacityMicromapArrayIndexingMode(IntEnum):
    """OptiX's `OptixOpacityMicromapArrayIndexingMode`."""

    NONE = 0
    LINEAR = 1
    INDEXED = 2


class OpacityMicromapFlags(IntFlag):
    """OptiX's `OptixOpacityMicromapFlags`."""

    NONE = 0
    PREFER_FAST_TRACE = 1
    PREFER_FAST_BUILD = 2


class OpacityMicromapFormat(IntEnum):
    """OptiX's `OptixOpacityMicromapFormat`."""

    NONE = 0
    FORMAT_2_STATE = 1
    FORMAT_4_STATE = 2


class PrimitiveType(IntEnum):
    """OptiX's `OptixPrimitiveType`."""

    CUSTOM = 0x2500
    ROUND_QUADRATIC_BSPLINE = 0x2501
    ROUND_CUBIC_BSPLINE = 0x2502
    ROUND_LINEAR = 0x2503
    ROUND_CATMULLROM = 0x2504
    FLAT_QUADRATIC_BSPLINE = 0x2505
    SPHERE = 0x2506
    ROUND_CUBIC_BEZIER = 0x2507
    ROUND_QUADRATIC_BSPLINE_ROCAPS = 0x2508
    ROUND_CUBIC_BSPLINE_ROCAPS = 0x2509
    ROUND_CATMULLROM_ROCAPS = 0x250A
    ROUND_CUBIC_BEZIER_ROCAPS = 0x250B
    TRIANGLE = 0x2531
    DISPLACED_MICROMESH_TRIANGLE = 0x2532


class PrimitiveTypeFlags(IntFlag):
    """OptiX's `OptixPrimitiveTypeFlags`."""

    CUSTOM = 1
    ROUND_QUADRATIC_BSPLINE = 2
    ROUND_CUBIC_BSPLINE = 4
    ROUND_LINEAR = 8
    ROUND_CATMULLROM = 16
    FLAT_QUADRATIC_BSPLINE = 32
    SPHERE = 64
    ROUND_CUBIC_BEZIER = 128
    ROUND_QUADRATIC_BSPLINE_ROCAPS = 0x100
    ROUND_CUBIC_BSPLINE_ROCAPS = 0x200
    ROUND_CATMULLROM_ROCAPS = 0x400
    ROUND_CUBIC_BEZIER_ROCAPS = 0x800
    TRIANGLE = 0x80000000
    DISPLACED_MICROMESH_TRIANGLE = 0x40000000


class RayFlags(IntFlag):
    """OptiX's `OptixRayFlags`."""

    NONE = 0
    DISABLE_ANYHIT = 1
    ENFORCE_ANYHIT = 2
    TERMINATE_ON_FIRST_HIT = 4
    DISABLE_CLOSESTHIT = 8
    CULL_BACK_FACING_TRIANGLES = 16
    CULL_FRONT_FACING_TRIANGLES = 32
    CULL_DISABLED_ANYHIT = 64
    CULL_ENFORCED_ANYHIT = 128
    FORCE_OPACITY_MICROMAP_2_STATE = 0x400


class TransformFormat(IntEnum):
    """OptiX's `OptixTransformFormat`."""

    NONE = 0
    MATRIX_FLOAT12 = 0x21E1


class TransformType(IntEnum):
    """OptiX's `OptixTransformType`."""

    NONE = 0
    STATIC_TRANSFORM = 1
    MATRIX_MOTION_TRANSFORM = 2
    SRT_MOTION_TRANSFORM = 3
    INSTANCE = 4


class TraversableGraphFlags(IntFlag):
    """OptiX's `OptixTraversableGraphFlags`; the longer names are those of OptiX."""

    ANY = 0
    SINGLE_GAS = 1
    SINGLE_LEVEL_INSTANCING = 2
    ALLOW_ANY = ANY
    ALLOW_SINGLE_GAS = SINGLE_GAS
    ALLOW_SINGLE_LEVEL_INSTANCING = SINGLE_LEVEL_INSTANCING


class TraversableType(IntEnum):
    """OptiX's `OptixTraversableType`."""

    STATIC_TRANSFORM = 0x21C1
    MATRIX_MOTION_TRANSFORM = 0x21C2
    SRT_MOTION_TRANSFORM = 0x21C3


class VertexFormat(IntEnum):
    """OptiX's `OptixVertexFormat`."""

    NONE = 0
    FLOAT3 = 0x2121
    FLOAT2 = 0x2122
    HALF3 = 0x2123
    HALF2 = 0x2124
    SNORM16_3 = 0x2125
    SNORM16_2 = 0x2126
