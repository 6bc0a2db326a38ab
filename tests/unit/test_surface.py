"""Names that users see: enumerations by the naming rule, errors by their codes, decorators in plain Python."""

from __future__ import annotations

import pytest

import optixc as ox
from optixc import errors


def test_members_drop_the_shared_prefix() -> None:
    assert ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_ANYHIT == 5
    assert ox.OpacityMicromapFormat.FORMAT_2_STATE == 1
    assert ox.PayloadTypeID.ID_0 == 1
    assert ox.CompileOptimizationLevel.LEVEL_1 == 0x2341
    assert ox.HitKind.BACK_FACE == 255
    assert ox.TraversableGraphFlags.ANY == 0
    assert ox.PrimitiveTypeFlags.TRIANGLE == 1 << 31
    assert ox.OPACITY_MICROMAP_PREDEFINED_INDEX_FULLY_OPAQUE == -2


def test_errors_have_optixs_codes() -> None:
    assert ox.InvalidValueError.code == 7001
    assert ox.ValidationFailureError.code == 7053
    assert errors.from_code(7251) is ox.PipelineLinkError
    assert errors.from_code(7900) is ox.LaunchCancelledError
    assert errors.from_code(12345) is ox.OptixError
    assert {int(code) for code in ox.Result if code} == {
        int(kind.code) for kind in ox.OptixError.__subclasses__() if kind.__module__ == errors.__name__
    }


def test_programs_cannot_be_called() -> None:
    @ox.program
    def __raygen__nothing() -> None:
        """Nothing."""

    with pytest.raises(TypeError, match=r"optixc\.interpret"):
        __raygen__nothing()
    assert __raygen__nothing.__doc__ == "Nothing."


def test_helpers_can_be_called() -> None:
    @ox.device
    def twice(x: float) -> float:
        return 2.0 * x

    assert twice(1.5) == 3.0


def test_a_program_needs_a_programs_name() -> None:
    with pytest.raises(TypeError, match="__raygen__"):

        @ox.program
        def shade() -> None:
            pass


def test_launch_parameters_have_no_values_outside() -> None:
    @ox.struct
    class Params:
        width: int

    params = ox.launch_params(Params)
    with pytest.raises(ox.InvalidOperationError, match=r"Params\.width"):
        _ = params.width
    with pytest.raises(ox.InvalidOperationError, match="read-only"):
        params.width = 3
    with pytest.raises(TypeError, match="struct"):
        ox.launch_params(int)


def test_every_device_function_has_a_python_face() -> None:
    for name in ("trace", "get_triangle_barycentrics", "atomic_add", "sqrt", "get_payload_31", "report_intersection", "get_sbt_data"):
        assert callable(getattr(ox, name)), name
