"""What describes programs, pipelines, contexts and results: OptiX's enumerations with OptiX's values."""

from __future__ import annotations

from enum import IntEnum, IntFlag


class CompileDebugLevel(IntEnum):
    """OptiX's `OptixCompileDebugLevel`."""

    DEFAULT = 0
    NONE = 0x2350
    MINIMAL = 0x2351
    MODERATE = 0x2353
    FULL = 0x2352


class CompileOptimizationLevel(IntEnum):
    """OptiX's `OptixCompileOptimizationLevel`."""

    DEFAULT = 0
    LEVEL_0 = 0x2340
    LEVEL_1 = 0x2341
    LEVEL_2 = 0x2342
    LEVEL_3 = 0x2343


class DeviceContextValidationMode(IntEnum):
    """OptiX's `OptixDeviceContextValidationMode`."""

    OFF = 0
    ALL = 0xFFFFFFFF


class DeviceProperty(IntEnum):
    """OptiX's `OptixDeviceProperty`."""

    LIMIT_MAX_TRACE_DEPTH = 0x2001
    LIMIT_MAX_TRAVERSABLE_GRAPH_DEPTH = 0x2002
    LIMIT_MAX_PRIMITIVES_PER_GAS = 0x2003
    LIMIT_MAX_INSTANCES_PER_IAS = 0x2004
    RTCORE_VERSION = 0x2005
    LIMIT_MAX_INSTANCE_ID = 0x2006
    LIMIT_NUM_BITS_INSTANCE_VISIBILITY_MASK = 0x2007
    LIMIT_MAX_SBT_RECORDS_PER_GAS = 0x2008
    LIMIT_MAX_SBT_OFFSET = 0x2009
    SHADER_EXECUTION_REORDERING = 0x200A
    COOP_VEC = 0x200B
    CLUSTER_ACCEL = 0x2020
    LIMIT_MAX_CLUSTER_VERTICES = 0x2021
    LIMIT_MAX_CLUSTER_TRIANGLES = 0x2022
    LIMIT_MAX_STRUCTURED_GRID_RESOLUTION = 0x2023


class DevicePropertyClusterAccelFlags(IntFlag):
    """OptiX's `OptixDevicePropertyClusterAccelFlags`."""

    NONE = 0
    STANDARD = 1


class DevicePropertyCoopVecFlags(IntFlag):
    """OptiX's `OptixDevicePropertyCoopVecFlags`."""

    NONE = 0
    STANDARD = 1


class DevicePropertyShaderExecutionReorderingFlags(IntFlag):
    """OptiX's `OptixDevicePropertyShaderExecutionReorderingFlags`."""

    NONE = 0
    STANDARD = 1


class ExceptionCodes(IntEnum):
    """OptiX's `OptixExceptionCodes`."""

    STACK_OVERFLOW = -1
    TRACE_DEPTH_EXCEEDED = -2


class ExceptionFlags(IntFlag):
    """OptiX's `OptixExceptionFlags`."""

    NONE = 0
    STACK_OVERFLOW = 1
    TRACE_DEPTH = 2
    USER = 4


class ModuleCompileState(IntEnum):
    """OptiX's `OptixModuleCompileState`."""

    NOT_STARTED = 0x2360
    STARTED = 0x2361
    IMPENDING_FAILURE = 0x2362
    FAILED = 0x2363
    COMPLETED = 0x2364


class PayloadSemantics(IntFlag):
    """OptiX's `OptixPayloadSemantics`."""

    TRACE_CALLER_NONE = 0
    TRACE_CALLER_READ = 1
    TRACE_CALLER_WRITE = 2
    TRACE_CALLER_READ_WRITE = 3
    CH_NONE = 0
    CH_READ = 4
    CH_WRITE = 8
    CH_READ_WRITE = 12
    MS_NONE = 0
    MS_READ = 16
    MS_WRITE = 32
    MS_READ_WRITE = 48
    AH_NONE = 0
    AH_READ = 64
    AH_WRITE = 128
    AH_READ_WRITE = 0xC0
    IS_NONE = 0
    IS_READ = 0x100
    IS_WRITE = 0x200
    IS_READ_WRITE = 0x300


class PayloadTypeID(IntFlag):
    """OptiX's `OptixPayloadTypeID`."""

    DEFAULT = 0
    ID_0 = 1
    ID_1 = 2
    ID_2 = 4
    ID_3 = 8
    ID_4 = 16
    ID_5 = 32
    ID_6 = 64
    ID_7 = 128


class ProgramGroupFlags(IntFlag):
    """OptiX's `OptixProgramGroupFlags`."""

    NONE = 0


class ProgramGroupKind(IntEnum):
    """OptiX's `OptixProgramGroupKind`."""

    RAYGEN = 0x2421
    MISS = 0x2422
    EXCEPTION = 0x2423
    HITGROUP = 0x2424
    CALLABLES = 0x2425


class Result(IntEnum):
    """OptiX's `OptixResult`."""

    SUCCESS = 0
    ERROR_INVALID_VALUE = 7001
    ERROR_HOST_OUT_OF_MEMORY = 7002
    ERROR_INVALID_OPERATION = 7003
    ERROR_FILE_IO_ERROR = 7004
    ERROR_INVALID_FILE_FORMAT = 7005
    ERROR_DISK_CACHE_INVALID_PATH = 7010
    ERROR_DISK_CACHE_PERMISSION_ERROR = 7011
    ERROR_DISK_CACHE_DATABASE_ERROR = 7012
    ERROR_DISK_CACHE_INVALID_DATA = 7013
    ERROR_LAUNCH_FAILURE = 7050
    ERROR_INVALID_DEVICE_CONTEXT = 7051
    ERROR_CUDA_NOT_INITIALIZED = 7052
    ERROR_VALIDATION_FAILURE = 7053
    ERROR_INVALID_INPUT = 7200
    ERROR_INVALID_LAUNCH_PARAMETER = 7201
    ERROR_INVALID_PAYLOAD_ACCESS = 7202
    ERROR_INVALID_ATTRIBUTE_ACCESS = 7203
    ERROR_INVALID_FUNCTION_USE = 7204
    ERROR_INVALID_FUNCTION_ARGUMENTS = 7205
    ERROR_PIPELINE_OUT_OF_CONSTANT_MEMORY = 7250
    ERROR_PIPELINE_LINK_ERROR = 7251
    ERROR_ILLEGAL_DURING_TASK_EXECUTE = 7270
    ERROR_INTERNAL_COMPILER_ERROR = 7299
    ERROR_DENOISER_MODEL_NOT_SET = 7300
    ERROR_DENOISER_NOT_INITIALIZED = 7301
    ERROR_NOT_COMPATIBLE = 7400
    ERROR_PAYLOAD_TYPE_MISMATCH = 7500
    ERROR_PAYLOAD_TYPE_RESOLUTION_FAILED = 7501
    ERROR_PAYLOAD_TYPE_ID_INVALID = 7502
    ERROR_NOT_SUPPORTED = 7800
    ERROR_UNSUPPORTED_ABI_VERSION = 7801
    ERROR_FUNCTION_TABLE_SIZE_MISMATCH = 7802
    ERROR_INVALID_ENTRY_FUNCTION_OPTIONS = 7803
    ERROR_LIBRARY_NOT_FOUND = 7804
    ERROR_ENTRY_SYMBOL_NOT_FOUND = 7805
    ERROR_LIBRARY_UNLOAD_FAILURE = 7806
    ERROR_DEVICE_OUT_OF_MEMORY = 7807
    ERROR_INVALID_POINTER = 7808
    ERROR_CUDA_ERROR = 7900
    ERROR_INTERNAL_ERROR = 7990
    ERROR_UNKNOWN = 7999
