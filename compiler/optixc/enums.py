"""All enumerations of the surface, by name; `import optixc as ox` shows them as `ox.RayFlags` and so on.

Constants that OptiX defines outside an enumeration keep their name without `OPTIX_`.
"""

from __future__ import annotations

from optixc.enums_extensions import (
    ClusterAccelBuildFlags,
    ClusterAccelBuildMode,
    ClusterAccelBuildType,
    ClusterAccelClusterFlags,
    ClusterAccelIndicesFormat,
    ClusterAccelPrimitiveFlags,
    ClusterIDValues,
    CoopVecElemType,
    CoopVecMatrixLayout,
    DenoiserAlphaMode,
    DenoiserAOVType,
    DenoiserModelKind,
    DisplacementMicromapArrayIndexingMode,
    DisplacementMicromapBiasAndScaleFormat,
    DisplacementMicromapDirectionFormat,
    DisplacementMicromapFlags,
    DisplacementMicromapFormat,
    DisplacementMicromapTriangleFlags,
    PixelFormat,
    QueryFunctionTableOptions,
)
from optixc.enums_program import (
    CompileDebugLevel,
    CompileOptimizationLevel,
    DeviceContextValidationMode,
    DeviceProperty,
    DevicePropertyClusterAccelFlags,
    DevicePropertyCoopVecFlags,
    DevicePropertyShaderExecutionReorderingFlags,
    ExceptionCodes,
    ExceptionFlags,
    ModuleCompileState,
    PayloadSemantics,
    PayloadTypeID,
    ProgramGroupFlags,
    ProgramGroupKind,
    Result,
)
from optixc.enums_scene import (
    AccelPropertyType,
    BuildFlags,
    BuildInputType,
    BuildOperation,
    CurveEndcapFlags,
    GeometryFlags,
    HitKind,
    IndicesFormat,
    InstanceFlags,
    MotionFlags,
    OpacityMicromapArrayIndexingMode,
    OpacityMicromapFlags,
    OpacityMicromapFormat,
    PrimitiveType,
    PrimitiveTypeFlags,
    RayFlags,
    TransformFormat,
    TransformType,
    TraversableGraphFlags,
    TraversableType,
    VertexFormat,
)

AABB_BUFFER_BYTE_ALIGNMENT = 8
ACCEL_BUFFER_BYTE_ALIGNMENT = 128
COMPILE_DEFAULT_MAX_PAYLOAD_TYPE_COUNT = 8
COMPILE_DEFAULT_MAX_PAYLOAD_VALUE_COUNT = 32
COMPILE_DEFAULT_MAX_REGISTER_COUNT = 0
DISPLACEMENT_MICROMAP_ARRAY_BUFFER_BYTE_ALIGNMENT = 128
DISPLACEMENT_MICROMAP_DESC_BUFFER_BYTE_ALIGNMENT = 8
DISPLACEMENT_MICROMAP_MAX_SUBDIVISION_LEVEL = 5
GEOMETRY_TRANSFORM_BYTE_ALIGNMENT = 16
INSTANCE_BYTE_ALIGNMENT = 16
OPACITY_MICROMAP_ARRAY_BUFFER_BYTE_ALIGNMENT = 128
OPACITY_MICROMAP_DESC_BUFFER_BYTE_ALIGNMENT = 8
OPACITY_MICROMAP_MAX_SUBDIVISION_LEVEL = 12
OPACITY_MICROMAP_PREDEFINED_INDEX_CLUSTER_SKIP_OPACITY_MICROMAP = -5
OPACITY_MICROMAP_PREDEFINED_INDEX_FULLY_OPAQUE = -2
OPACITY_MICROMAP_PREDEFINED_INDEX_FULLY_TRANSPARENT = -1
OPACITY_MICROMAP_PREDEFINED_INDEX_FULLY_UNKNOWN_OPAQUE = -4
OPACITY_MICROMAP_PREDEFINED_INDEX_FULLY_UNKNOWN_TRANSPARENT = -3
OPACITY_MICROMAP_STATE_OPAQUE = 1
OPACITY_MICROMAP_STATE_TRANSPARENT = 0
OPACITY_MICROMAP_STATE_UNKNOWN_OPAQUE = 3
OPACITY_MICROMAP_STATE_UNKNOWN_TRANSPARENT = 2
SBT_RECORD_ALIGNMENT = 16
SBT_RECORD_HEADER_SIZE = 32
TRANSFORM_BYTE_ALIGNMENT = 64

__all__ = [
    "AABB_BUFFER_BYTE_ALIGNMENT",
    "ACCEL_BUFFER_BYTE_ALIGNMENT",
    "COMPILE_DEFAULT_MAX_PAYLOAD_TYPE_COUNT",
    "COMPILE_DEFAULT_MAX_PAYLOAD_VALUE_COUNT",
    "COMPILE_DEFAULT_MAX_REGISTER_COUNT",
    "DISPLACEMENT_MICROMAP_ARRAY_BUFFER_BYTE_ALIGNMENT",
    "DISPLACEMENT_MICROMAP_DESC_BUFFER_BYTE_ALIGNMENT",
    "DISPLACEMENT_MICROMAP_MAX_SUBDIVISION_LEVEL",
    "GEOMETRY_TRANSFORM_BYTE_ALIGNMENT",
    "INSTANCE_BYTE_ALIGNMENT",
    "OPACITY_MICROMAP_ARRAY_BUFFER_BYTE_ALIGNMENT",
    "OPACITY_MICROMAP_DESC_BUFFER_BYTE_ALIGNMENT",
    "OPACITY_MICROMAP_MAX_SUBDIVISION_LEVEL",
    "OPACITY_MICROMAP_PREDEFINED_INDEX_CLUSTER_SKIP_OPACITY_MICROMAP",
    "OPACITY_MICROMAP_PREDEFINED_INDEX_FULLY_OPAQUE",
    "OPACITY_MICROMAP_PREDEFINED_INDEX_FULLY_TRANSPARENT",
    "OPACITY_MICROMAP_PREDEFINED_INDEX_FULLY_UNKNOWN_OPAQUE",
    "OPACITY_MICROMAP_PREDEFINED_INDEX_FULLY_UNKNOWN_TRANSPARENT",
    "OPACITY_MICROMAP_STATE_OPAQUE",
    "OPACITY_MICROMAP_STATE_TRANSPARENT",
    "OPACITY_MICROMAP_STATE_UNKNOWN_OPAQUE",
    "OPACITY_MICROMAP_STATE_UNKNOWN_TRANSPARENT",
    "SBT_RECORD_ALIGNMENT",
    "SBT_RECORD_HEADER_SIZE",
    "TRANSFORM_BYTE_ALIGNMENT",
    "AccelPropertyType",
    "BuildFlags",
    "BuildInputType",
    "BuildOperation",
    "ClusterAccelBuildFlags",
    "ClusterAccelBuildMode",
    "ClusterAccelBuildType",
    "ClusterAccelClusterFlags",
    "ClusterAccelIndicesFormat",
    "ClusterAccelPrimitiveFlags",
    "ClusterIDValues",
    "CompileDebugLevel",
    "CompileOptimizationLevel",
    "CoopVecElemType",
    "CoopVecMatrixLayout",
    "CurveEndcapFlags",
    "DenoiserAOVType",
    "DenoiserAlphaMode",
    "DenoiserModelKind",
    "DeviceContextValidationMode",
    "DeviceProperty",
    "DevicePropertyClusterAccelFlags",
    "DevicePropertyCoopVecFlags",
    "DevicePropertyShaderExecutionReorderingFlags",
    "DisplacementMicromapArrayIndexingMode",
    "DisplacementMicromapBiasAndScaleFormat",
    "DisplacementMicromapDirectionFormat",
    "DisplacementMicromapFlags",
    "DisplacementMicromapFormat",
    "DisplacementMicromapTriangleFlags",
    "ExceptionCodes",
    "ExceptionFlags",
    "GeometryFlags",
    "HitKind",
    "IndicesFormat",
    "InstanceFlags",
    "ModuleCompileState",
    "MotionFlags",
    "OpacityMicromapArrayIndexingMode",
    "OpacityMicromapFlags",
    "OpacityMicromapFormat",
    "PayloadSemantics",
    "PayloadTypeID",
    "PixelFormat",
    "PrimitiveType",
    "PrimitiveTypeFlags",
    "ProgramGroupFlags",
    "ProgramGroupKind",
    "QueryFunctionTableOptions",
    "RayFlags",
    "Result",
    "TransformFormat",
    "TransformType",
    "TraversableGraphFlags",
    "TraversableType",
    "VertexFormat",
]
