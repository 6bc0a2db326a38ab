import numpy as np

import optixc as ox


@ox.program
def __raygen__a():
    a = ox.optixGetLaunchIndex()  # E[OX301]: did you mean `ox.get_launch_index`?
    b = ox.getLaunchDimensions()  # E[OX301]: did you mean `ox.get_launch_dimensions`?
    c = optixGetLaunchIndex()  # E[OX301]: did you mean `ox.get_launch_index`?
    d = ox.get_sbt_data_pointer()  # E[OX301]: `ox.get_sbt_data(Struct)` is the record's data
    e = ox.optixGetSbtDataPointer()  # E[OX301]: `ox.get_sbt_data(Struct)` is the record's data
    f = ox.make_float3(1.0, 2.0, 3.0)  # E[OX301]: did you mean `ox.float3`?
    g = sqrtf(2.0)  # E[OX301]: did you mean `ox.sqrt`?
    h = fmaxf(1.0, 2.0)  # E[OX301]: did you mean `ox.max`?
    i = ox.__float_as_uint(1.0)  # E[OX301]: did you mean `ox.float_as_uint`?
    j = normalize(ox.float3(1.0))  # E[OX301]: did you mean `ox.normalize`?
    k = ox.get_launch_dimension()  # E[OX301]: did you mean `ox.get_launch_dimensions`?
    l = ox.atomicAdd(1)  # E[OX301]: did you mean `ox.atomic_add`?
    m = ox.get_weather()  # E[OX301]: docs/language/device-functions.md lists all
    n = weather  # E[OX301]: nothing defines it


def make_floats():
    return 1.0


@ox.program
def __raygen__b():
    a = make_float3(1.0, 2.0, 3.0)  # E[OX301]: did you mean `ox.float3`?
    b = OPTIX_RAY_FLAG_DISABLE_ANYHIT  # E[OX301]: did you mean `ox.RayFlags.DISABLE_ANYHIT`?
    c = ox.OPTIX_PRIMITIVE_TYPE_SPHERE  # E[OX301]: did you mean `ox.PrimitiveType.SPHERE`?
    d = OPTIX_HIT_KIND_TRIANGLE_FRONT_FACE  # E[OX301]: did you mean `ox.HitKind.TRIANGLE_FRONT_FACE`?
    e = OPTIX_EXCEPTION_CODE_STACK_OVERFLOW  # E[OX301]: did you mean `ox.ExceptionCodes.STACK_OVERFLOW`?
    f = OptixVisibilityMask(255)  # E[OX301]: a visibility mask is a plain number of 8 bits
    g = OPTIX_WEATHER_SUNNY  # E[OX301]: nothing defines it
    i = np.sqrt(2.0)  # E[OX206]: did you mean `ox.sqrt`?
    j = np.pi  # E[OX206]: did you mean `ox.pi`?
    k = np.array(1.0)  # E[OX206]: only constants and helpers can
    h = make_float()  # E[OX301]: did you mean `make_floats`?
    p, q = ox.trace(ox.Traversable(0), ox.float3(0.0), ox.float3(1.0), 0.0, 1.0, 0.0, 255, 0, 0, 1, 0, 1, 2)  # E[OX305]: payload=(p0, p1)


@ox.program
def __exception__a():
    a = ox.get_exception_line_info()  # E[OX301]: the error of a failed launch tells program, path and line
