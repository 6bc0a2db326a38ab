"""OptiX's structs for docs/coming_from_optix.md: what stands for each here, and where those fields are that have another name or none.

A field that the remark does not name is the argument of the same name in snake case.
"""

from __future__ import annotations

SBT = "sbtIndexOffsetBuffer is `sbt_index_offsets`; sbtIndexOffsetSizeInBytes, sbtIndexOffsetStrideInBytes: the array tells"
NO_MEMORY = "memory is the library's"

STRUCTS: tuple[tuple[str, str, str], ...] = (
    (
        "OptixAabb",
        "",
        "six float32: a row of `aabbs`; `Accel.aabb` is (lower, upper), (minX, minY, minZ), (maxX, maxY, maxZ)",
    ),
    ("OptixAccelBufferSizes", "Accel.memory_usage", f"one number; outputSizeInBytes, tempSizeInBytes, tempUpdateSizeInBytes: {NO_MEMORY}"),
    ("OptixAccelBuildOptions", "DeviceContext.accel_build", "operation: `accel_build` or `Accel.update`"),
    ("OptixAccelEmitDesc", "Accel.emit_property", "type is `property_type`; result is returned"),
    (
        "OptixBuildInput",
        "",
        "one class for each type: triangleArray `BuildInputTriangles`, curveArray `BuildInputCurves`, sphereArray `BuildInputSpheres`, "
        "customPrimitiveArray `BuildInputCustomPrimitives`, instanceArray `BuildInputInstances` (pad)",
    ),
    (
        "OptixBuildInputTriangleArray",
        "BuildInputTriangles",
        "vertexBuffers is `vertices`, indexBuffer `indices`; numVertices, vertexStrideInBytes, numIndexTriplets, indexFormat, "
        f"indexStrideInBytes: the arrays tell; {SBT}; transformFormat: `pre_transform` or None; displacementMicromap: none",
    ),
    (
        "OptixBuildInputCurveArray",
        "BuildInputCurves",
        "vertexBuffers is `vertices`, widthBuffers `radii`, normalBuffers `normals`, indexBuffer `indices`, flag `flags`; numPrimitives, "
        "numVertices, vertexStrideInBytes, widthStrideInBytes, normalStrideInBytes, indexStrideInBytes: the arrays tell",
    ),
    (
        "OptixBuildInputSphereArray",
        "BuildInputSpheres",
        "vertexBuffers is `centers`, radiusBuffers `radii`; singleRadius: one number in `radii`; vertexStrideInBytes, numVertices, "
        f"radiusStrideInBytes: the arrays tell; {SBT}",
    ),
    (
        "OptixBuildInputCustomPrimitiveArray",
        "BuildInputCustomPrimitives",
        f"aabbBuffers is `aabbs`; numPrimitives, strideInBytes: the array tells; {SBT}",
    ),
    ("OptixBuildInputInstanceArray", "BuildInputInstances", "a list, or arrays; numInstances, instanceStride: they tell"),
    (
        "OptixBuildInputOpacityMicromap",
        "BuildInputOpacityMicromap",
        "opacityMicromapArray is `array`, indexBuffer `indices`, micromapUsageCounts `usage_counts`; indexingMode: INDEXED with "
        "`indices`, else LINEAR, NONE without `array`; indexSizeInBytes, indexStrideInBytes, numMicromapUsageCounts: the arrays tell",
    ),
    ("OptixBuiltinISOptions", "", "not needed (builtinISModuleType, usesMotionBlur, buildFlags, curveEndcapFlags)"),
    (
        "OptixDeviceContextOptions",
        "DeviceContext",
        "logCallbackFunction is `log_callback`, logCallbackData: what it closes over, logCallbackLevel: `set_log_callback(f, level)`, "
        "validationMode is `validation`",
    ),
    ("OptixInstance", "Instance", "traversableHandle is `traversable`; pad"),
    ("OptixMotionOptions", "MotionOptions", ""),
    ("OptixStaticTransform", "DeviceContext.static_transform", "invTransform is worked out; pad"),
    ("OptixMatrixMotionTransform", "DeviceContext.matrix_motion_transform", "transform is `keys`, (n, 3, 4); pad"),
    ("OptixSRTMotionTransform", "DeviceContext.srt_motion_transform", "srtData is `keys`, (n, 16); pad"),
    (
        "OptixSRTData",
        "",
        "a row of 16 numbers in this order: sx, a, b, pvx, sy, c, pvy, sz, pvz, qx, qy, qz, qw, tx, ty, tz",
    ),
    (
        "OptixModuleCompileOptions",
        "DeviceContext.pipeline_create",
        "debugLevel: `debug`; optLevel: full unless `debug` (`-O0` to `-O3` of the command); maxRegisterCount: none; "
        "numBoundValues: `bound_values` is a dictionary; payloadTypes, numPayloadTypes: payload classes are found in the programs",
    ),
    (
        "OptixModuleCompileBoundValueEntry",
        "BoundValue",
        "boundValuePtr is `value`; pipelineParamOffsetInBytes, sizeInBytes: the key names the field",
    ),
    ("OptixPayloadType", "payload_word", "numPayloadValues: the fields of an `@ox.payload` class; payloadSemantics: `payload_word(...)`"),
    ("OptixPipelineCompileOptions", "PipelineCompileOptions", ""),
    ("OptixPipelineLinkOptions", "DeviceContext.pipeline_create", ""),
    (
        "OptixProgramGroupDesc",
        "DeviceContext.program_group_create",
        "keywords: `raygen`, `miss`, `exception`; hitgroup: `closesthit`, `anyhit`, `intersection`; callables: `direct_callable`, "
        "`continuation_callable`; kind follows from them; flags: none are defined",
    ),
    ("OptixProgramGroupSingleModule", "Module", "`module[entryFunctionName]`"),
    (
        "OptixProgramGroupHitgroup",
        "Module",
        "moduleCH, entryFunctionNameCH: `closesthit=module[name]`; moduleAH, entryFunctionNameAH: `anyhit`; moduleIS, "
        "entryFunctionNameIS: `intersection`",
    ),
    (
        "OptixProgramGroupCallables",
        "Module",
        "moduleDC, entryFunctionNameDC: `direct_callable=module[name]`; moduleCC, entryFunctionNameCC: `continuation_callable`",
    ),
    ("OptixProgramGroupOptions", "", "payloadType: that of the programs"),
    (
        "OptixShaderBindingTable",
        "ShaderBindingTable",
        "raygenRecord is `raygen`, exceptionRecord `exception`; missRecordBase, missRecordCount: the list `miss`; hitgroupRecordBase, "
        "hitgroupRecordCount: `hitgroup`; callablesRecordBase, callablesRecordCount: `callables`; missRecordStrideInBytes, "
        "hitgroupRecordStrideInBytes, callablesRecordStrideInBytes: the largest record's",
    ),
    ("OptixStackSizes", "StackSizes", ""),
    ("OptixTraverseData", "TraverseData", "data: 20 uint32"),
    ("OptixCoopVecMatrixDescription", "CoopVecMatrixDescription", "N, K are `n`, `k`"),
    ("OptixNetworkDescription", "NetworkDescription", "numLayers: the list tells"),
    (
        "OptixOpacityMicromapArrayBuildInput",
        "DeviceContext.opacity_micromap_array_build",
        "inputBuffer is `data`, perMicromapDescBuffer `descs`, micromapHistogramEntries `histogram`; perMicromapDescStrideInBytes, "
        "numMicromapHistogramEntries: the arrays tell",
    ),
    ("OptixOpacityMicromapDesc", "", "a row of `descs`: byteOffset, subdivisionLevel, format; or `OpacityMicromap(states, level, format)`"),
    (
        "OptixOpacityMicromapHistogramEntry, OptixOpacityMicromapUsageCount",
        "",
        "a row (count, subdivisionLevel, format) of `histogram`, `usage_counts`; left out, they are counted",
    ),
    ("OptixMicromapBufferSizes, OptixMicromapBuffers", "", f"outputSizeInBytes, tempSizeInBytes, output, temp: {NO_MEMORY}"),
    ("OptixRelocationInfo", "Accel.relocate", "info: not needed"),
    (
        "OptixRelocateInput, OptixRelocateInputInstanceArray, OptixRelocateInputTriangleArray, OptixRelocateInputOpacityMicromap",
        "Accel.relocate",
        "instanceArray, traversableHandles: `children`; the rest (type, numInstances, triangleArray, numSbtRecords, opacityMicromap, "
        "opacityMicromapArray) stays as it was",
    ),
    (
        "OptixInvalidRayExceptionDetails, OptixParameterMismatchExceptionDetails",
        "",
        "OptiX 8; here in the text of the error and in what `get_exception_detail_0` to `_7` give (origin, direction, tmin, tmax, time; "
        "expectedParameterCount, passedArgumentCount, sbtIndex, callableName)",
    ),
    ("OptixDisplacementMicromap..., OptixBuildInputDisplacementMicromap", "", "none: dropped by OptiX 9"),
    ("OptixClusterAccel...", "", "none: no clusters on a CPU"),
    ("OptixDenoiser..., OptixImage2D", "", "none: no denoiser"),
)


ENUMS = """Every enumeration is there under its name without `Optix`, with OptiX's values: a member is its name without the prefix that all
members of it share (`OPTIX_RAY_FLAG_DISABLE_ANYHIT` is `ox.RayFlags.DISABLE_ANYHIT`, `OPTIX_PAYLOAD_TYPE_ID_0` is `ox.PayloadTypeID.ID_0`).
Constants that OptiX `#define`s lose `OPTIX_`: `ox.OPACITY_MICROMAP_STATE_OPAQUE`."""


def section() -> list[str]:
    """The lines of the page."""
    lines = ["", "## Structs", "", "Fields that the remark leaves out are arguments of the same name in snake case.", ""]
    lines += ["| OptiX | here | fields |", "|---|---|---|"]
    lines += [f"| {optix} | {f'`{here}`' if here else ''} | {remark} |" for optix, here, remark in STRUCTS]
    return [*lines, "", "## Enumerations", "", *ENUMS.split("\n")]
