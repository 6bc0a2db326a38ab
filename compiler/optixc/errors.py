"""Exceptions for OptiX's result codes: one class a code, `code` is OptiX's number.

Everything that this package raises about a wrong call is one of these; `from_code` finds the class of a result of the runtime.
"""

from __future__ import annotations

from optixc.enums_program import Result


class OptixError(Exception):
    """A call failed; `code` says how in OptiX's numbers, the text says what was wrong and what to do."""

    code: Result = Result.ERROR_UNKNOWN
    fault_code: int | None = None
    """Of a failed launch: OXRT_FAULT_..., with the launch index and the line of the shader where it happened."""
    launch_index: tuple[int, ...] | None = None
    path: str | None = None
    line: int | None = None
    program: str | None = None
    """The program or helper that holds this line."""


class InvalidValueError(OptixError, ValueError):
    code = Result.ERROR_INVALID_VALUE


class HostOutOfMemoryError(OptixError):
    code = Result.ERROR_HOST_OUT_OF_MEMORY


class InvalidOperationError(OptixError):
    code = Result.ERROR_INVALID_OPERATION


class FileIoError(OptixError):
    code = Result.ERROR_FILE_IO_ERROR


class InvalidFileFormatError(OptixError):
    code = Result.ERROR_INVALID_FILE_FORMAT


class DiskCacheInvalidPathError(OptixError):
    code = Result.ERROR_DISK_CACHE_INVALID_PATH


class DiskCachePermissionError(OptixError):
    code = Result.ERROR_DISK_CACHE_PERMISSION_ERROR


class DiskCacheDatabaseError(OptixError):
    code = Result.ERROR_DISK_CACHE_DATABASE_ERROR


class DiskCacheInvalidDataError(OptixError):
    code = Result.ERROR_DISK_CACHE_INVALID_DATA


class LaunchFailureError(OptixError):
    code = Result.ERROR_LAUNCH_FAILURE


class InvalidDeviceContextError(OptixError):
    code = Result.ERROR_INVALID_DEVICE_CONTEXT


class CudaNotInitializedError(OptixError):
    code = Result.ERROR_CUDA_NOT_INITIALIZED


class ValidationFailureError(OptixError):
    code = Result.ERROR_VALIDATION_FAILURE


class InvalidInputError(OptixError):
    code = Result.ERROR_INVALID_INPUT


class InvalidLaunchParameterError(OptixError):
    code = Result.ERROR_INVALID_LAUNCH_PARAMETER


class InvalidPayloadAccessError(OptixError):
    code = Result.ERROR_INVALID_PAYLOAD_ACCESS


class InvalidAttributeAccessError(OptixError):
    code = Result.ERROR_INVALID_ATTRIBUTE_ACCESS


class InvalidFunctionUseError(OptixError):
    code = Result.ERROR_INVALID_FUNCTION_USE


class InvalidFunctionArgumentsError(OptixError):
    code = Result.ERROR_INVALID_FUNCTION_ARGUMENTS


class PipelineOutOfConstantMemoryError(OptixError):
    code = Result.ERROR_PIPELINE_OUT_OF_CONSTANT_MEMORY


class PipelineLinkError(OptixError):
    code = Result.ERROR_PIPELINE_LINK_ERROR


class IllegalDuringTaskExecuteError(OptixError):
    code = Result.ERROR_ILLEGAL_DURING_TASK_EXECUTE


class InternalCompilerError(OptixError):
    code = Result.ERROR_INTERNAL_COMPILER_ERROR


class DenoiserModelNotSetError(OptixError):
    code = Result.ERROR_DENOISER_MODEL_NOT_SET


class DenoiserNotInitializedError(OptixError):
    code = Result.ERROR_DENOISER_NOT_INITIALIZED


class NotCompatibleError(OptixError):
    code = Result.ERROR_NOT_COMPATIBLE


class PayloadTypeMismatchError(OptixError):
    code = Result.ERROR_PAYLOAD_TYPE_MISMATCH


class PayloadTypeResolutionFailedError(OptixError):
    code = Result.ERROR_PAYLOAD_TYPE_RESOLUTION_FAILED


class PayloadTypeIdInvalidError(OptixError):
    code = Result.ERROR_PAYLOAD_TYPE_ID_INVALID


class NotSupportedError(OptixError):
    code = Result.ERROR_NOT_SUPPORTED


class UnsupportedAbiVersionError(OptixError):
    code = Result.ERROR_UNSUPPORTED_ABI_VERSION


class FunctionTableSizeMismatchError(OptixError):
    code = Result.ERROR_FUNCTION_TABLE_SIZE_MISMATCH


class InvalidEntryFunctionOptionsError(OptixError):
    code = Result.ERROR_INVALID_ENTRY_FUNCTION_OPTIONS


class LibraryNotFoundError(OptixError):
    code = Result.ERROR_LIBRARY_NOT_FOUND


class EntrySymbolNotFoundError(OptixError):
    code = Result.ERROR_ENTRY_SYMBOL_NOT_FOUND


class LibraryUnloadFailureError(OptixError):
    code = Result.ERROR_LIBRARY_UNLOAD_FAILURE


class DeviceOutOfMemoryError(OptixError):
    code = Result.ERROR_DEVICE_OUT_OF_MEMORY


class InvalidPointerError(OptixError):
    code = Result.ERROR_INVALID_POINTER


class CudaError(OptixError):
    code = Result.ERROR_CUDA_ERROR


class InternalError(OptixError):
    code = Result.ERROR_INTERNAL_ERROR


class UnknownError(OptixError):
    code = Result.ERROR_UNKNOWN


LaunchCancelledError = CudaError
"""What a cancelled launch raises where no KeyboardInterrupt is on its way: 7900, which OptiX uses for errors of its driver."""

_BY_CODE: dict[int, type[OptixError]] = {int(kind.code): kind for kind in OptixError.__subclasses__()}


def from_code(code: int) -> type[OptixError]:
    """The exception class of a result code, OptixError itself for a code that OptiX does not know."""
    return _BY_CODE.get(code, OptixError)


_CODES = frozenset(map(int, Result))
_UNKNOWN_CODE = "Unrecognized OptixResult code"
_TEXTS = {
    Result.SUCCESS: "Success",
    Result.ERROR_HOST_OUT_OF_MEMORY: "Host is out of memory",
    Result.ERROR_FILE_IO_ERROR: "File I/O error",
    Result.ERROR_NOT_SUPPORTED: "Feature is not supported",
    Result.ERROR_UNSUPPORTED_ABI_VERSION: "Unsupported ABI version",
    Result.ERROR_CUDA_NOT_INITIALIZED: "CUDA is not initialized",
    Result.ERROR_CUDA_ERROR: "CUDA error",
    Result.ERROR_PAYLOAD_TYPE_ID_INVALID: "Payload type ID is invalid",
}


def get_error_name(result: int) -> str:
    """OptiX's optixGetErrorName: the enumerator of a result code, e.g. "OPTIX_ERROR_INVALID_VALUE"."""
    return f"OPTIX_{Result(result).name}" if result in _CODES else _UNKNOWN_CODE


def get_error_string(result: int) -> str:
    """OptiX's optixGetErrorString: a few words about a result code, e.g. "Invalid value"."""
    if result not in _CODES:
        return _UNKNOWN_CODE
    code = Result(result)
    return _TEXTS.get(code, code.name.removeprefix("ERROR_").replace("_", " ").capitalize())


__all__ = [
    "CudaError",
    "CudaNotInitializedError",
    "DenoiserModelNotSetError",
    "DenoiserNotInitializedError",
    "DeviceOutOfMemoryError",
    "DiskCacheDatabaseError",
    "DiskCacheInvalidDataError",
    "DiskCacheInvalidPathError",
    "DiskCachePermissionError",
    "EntrySymbolNotFoundError",
    "FileIoError",
    "FunctionTableSizeMismatchError",
    "HostOutOfMemoryError",
    "IllegalDuringTaskExecuteError",
    "InternalCompilerError",
    "InternalError",
    "InvalidAttributeAccessError",
    "InvalidDeviceContextError",
    "InvalidEntryFunctionOptionsError",
    "InvalidFileFormatError",
    "InvalidFunctionArgumentsError",
    "InvalidFunctionUseError",
    "InvalidInputError",
    "InvalidLaunchParameterError",
    "InvalidOperationError",
    "InvalidPayloadAccessError",
    "InvalidPointerError",
    "InvalidValueError",
    "LaunchCancelledError",
    "LaunchFailureError",
    "LibraryNotFoundError",
    "LibraryUnloadFailureError",
    "NotCompatibleError",
    "NotSupportedError",
    "OptixError",
    "PayloadTypeIdInvalidError",
    "PayloadTypeMismatchError",
    "PayloadTypeResolutionFailedError",
    "PipelineLinkError",
    "PipelineOutOfConstantMemoryError",
    "UnknownError",
    "UnsupportedAbiVersionError",
    "ValidationFailureError",
    "get_error_name",
    "get_error_string",
]
