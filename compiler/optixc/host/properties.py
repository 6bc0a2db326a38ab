"""Limits and abilities of a context: OptiX's device properties with the values that hold here."""

from __future__ import annotations

from optixc.enums_program import DeviceProperty, DevicePropertyCoopVecFlags
from optixc.errors import InvalidValueError

_VALUES: dict[DeviceProperty, int] = {
    DeviceProperty.LIMIT_MAX_TRACE_DEPTH: 31,
    DeviceProperty.LIMIT_MAX_TRAVERSABLE_GRAPH_DEPTH: 31,
    DeviceProperty.LIMIT_MAX_PRIMITIVES_PER_GAS: 1 << 29,
    DeviceProperty.LIMIT_MAX_INSTANCES_PER_IAS: 1 << 28,
    DeviceProperty.RTCORE_VERSION: 0,
    DeviceProperty.LIMIT_MAX_INSTANCE_ID: (1 << 28) - 1,
    DeviceProperty.LIMIT_NUM_BITS_INSTANCE_VISIBILITY_MASK: 8,
    DeviceProperty.LIMIT_MAX_SBT_RECORDS_PER_GAS: 1 << 24,
    DeviceProperty.LIMIT_MAX_SBT_OFFSET: (1 << 28) - 1,
    DeviceProperty.SHADER_EXECUTION_REORDERING: 0,
    DeviceProperty.COOP_VEC: int(DevicePropertyCoopVecFlags.STANDARD),
    DeviceProperty.CLUSTER_ACCEL: 0,
    DeviceProperty.LIMIT_MAX_CLUSTER_VERTICES: 256,
    DeviceProperty.LIMIT_MAX_CLUSTER_TRIANGLES: 256,
    DeviceProperty.LIMIT_MAX_STRUCTURED_GRID_RESOLUTION: 11,
}


def property_value(wanted: DeviceProperty | int) -> int:
    """The value of a property. Raises InvalidValueError for a number that is none."""
    try:
        return _VALUES[DeviceProperty(wanted)]
    except ValueError:
        raise InvalidValueError(f"{wanted!r} is no device property; take one of ox.DeviceProperty") from None
