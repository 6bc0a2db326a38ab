"""Device functions for editors and type checkers. Written by docs/generate.py from the table of device functions."""

# mypy: disable-error-code="overload-overlap"

from typing import Any, TypeVar, overload

from optixc.host.annotations import Texture, Traversable
from optixc.host.matrices import float3x3, float3x4, float4x4
from optixc.host.vectors import Vector, float2, float3, float4, uint3

_V = TypeVar("_V", bound=Vector)
_S = TypeVar("_S")
_P = TypeVar("_P", bound=tuple[Any, ...])

__all__ = [
    "abs",
    "acos",
    "asin",
    "atan",
    "atan2",
    "atomic_add",
    "atomic_and",
    "atomic_cas",
    "atomic_dec",
    "atomic_exch",
    "atomic_inc",
    "atomic_max",
    "atomic_min",
    "atomic_or",
    "atomic_sub",
    "atomic_xor",
    "ceil",
    "clamp",
    "clz",
    "continuation_call",
    "coop_vec_add",
    "coop_vec_cvt",
    "coop_vec_exp2",
    "coop_vec_ffma",
    "coop_vec_get_matrix_size",
    "coop_vec_load",
    "coop_vec_log2",
    "coop_vec_mat_mul",
    "coop_vec_max",
    "coop_vec_min",
    "coop_vec_mul",
    "coop_vec_outer_product_accumulate",
    "coop_vec_reduce_sum_accumulate",
    "coop_vec_step",
    "coop_vec_sub",
    "coop_vec_tanh",
    "copysign",
    "cos",
    "cosh",
    "cross",
    "ctz",
    "degrees",
    "determinant",
    "direct_call",
    "distance",
    "dot",
    "exp",
    "exp2",
    "faceforward",
    "float_as_int",
    "float_as_uint",
    "floor",
    "fma",
    "fmod",
    "fract",
    "get_attribute_0",
    "get_attribute_1",
    "get_attribute_2",
    "get_attribute_3",
    "get_attribute_4",
    "get_attribute_5",
    "get_attribute_6",
    "get_attribute_7",
    "get_catmull_rom_rocaps_vertex_data",
    "get_catmull_rom_rocaps_vertex_data_from_handle",
    "get_catmull_rom_vertex_data",
    "get_catmull_rom_vertex_data_from_handle",
    "get_cluster_id",
    "get_cubic_bezier_rocaps_vertex_data",
    "get_cubic_bezier_rocaps_vertex_data_from_handle",
    "get_cubic_bezier_vertex_data",
    "get_cubic_bezier_vertex_data_from_handle",
    "get_cubic_bspline_rocaps_vertex_data",
    "get_cubic_bspline_rocaps_vertex_data_from_handle",
    "get_cubic_bspline_vertex_data",
    "get_cubic_bspline_vertex_data_from_handle",
    "get_curve_parameter",
    "get_exception_code",
    "get_exception_detail_0",
    "get_exception_detail_1",
    "get_exception_detail_2",
    "get_exception_detail_3",
    "get_exception_detail_4",
    "get_exception_detail_5",
    "get_exception_detail_6",
    "get_exception_detail_7",
    "get_gas_motion_step_count",
    "get_gas_motion_time_begin",
    "get_gas_motion_time_end",
    "get_gas_pointer_from_handle",
    "get_gas_traversable_handle",
    "get_geometric_normal",
    "get_hit_kind",
    "get_instance_child_from_handle",
    "get_instance_id",
    "get_instance_id_from_handle",
    "get_instance_index",
    "get_instance_inverse_transform_from_handle",
    "get_instance_transform_from_handle",
    "get_instance_traversable_from_ias",
    "get_launch_dimensions",
    "get_launch_index",
    "get_linear_curve_vertex_data",
    "get_linear_curve_vertex_data_from_handle",
    "get_matrix_motion_transform_from_handle",
    "get_object_ray_direction",
    "get_object_ray_origin",
    "get_object_to_world_transform_matrix",
    "get_payload_0",
    "get_payload_1",
    "get_payload_2",
    "get_payload_3",
    "get_payload_4",
    "get_payload_5",
    "get_payload_6",
    "get_payload_7",
    "get_payload_8",
    "get_payload_9",
    "get_payload_10",
    "get_payload_11",
    "get_payload_12",
    "get_payload_13",
    "get_payload_14",
    "get_payload_15",
    "get_payload_16",
    "get_payload_17",
    "get_payload_18",
    "get_payload_19",
    "get_payload_20",
    "get_payload_21",
    "get_payload_22",
    "get_payload_23",
    "get_payload_24",
    "get_payload_25",
    "get_payload_26",
    "get_payload_27",
    "get_payload_28",
    "get_payload_29",
    "get_payload_30",
    "get_payload_31",
    "get_primitive_index",
    "get_primitive_type",
    "get_quadratic_bspline_rocaps_vertex_data",
    "get_quadratic_bspline_rocaps_vertex_data_from_handle",
    "get_quadratic_bspline_vertex_data",
    "get_quadratic_bspline_vertex_data_from_handle",
    "get_ray_flags",
    "get_ray_time",
    "get_ray_tmax",
    "get_ray_tmin",
    "get_ray_visibility_mask",
    "get_ribbon_normal",
    "get_ribbon_normal_from_handle",
    "get_ribbon_parameters",
    "get_ribbon_vertex_data",
    "get_ribbon_vertex_data_from_handle",
    "get_sbt_data",
    "get_sbt_gas_index",
    "get_sphere_data",
    "get_sphere_data_from_handle",
    "get_srt_motion_transform_from_handle",
    "get_static_transform_from_handle",
    "get_transform_list_handle",
    "get_transform_list_size",
    "get_transform_type_from_handle",
    "get_triangle_barycentrics",
    "get_triangle_vertex_data",
    "get_triangle_vertex_data_from_handle",
    "get_world_ray_direction",
    "get_world_ray_origin",
    "get_world_to_object_transform_matrix",
    "hit_object_get_attribute_0",
    "hit_object_get_attribute_1",
    "hit_object_get_attribute_2",
    "hit_object_get_attribute_3",
    "hit_object_get_attribute_4",
    "hit_object_get_attribute_5",
    "hit_object_get_attribute_6",
    "hit_object_get_attribute_7",
    "hit_object_get_catmull_rom_rocaps_vertex_data",
    "hit_object_get_catmull_rom_vertex_data",
    "hit_object_get_cluster_id",
    "hit_object_get_cubic_bezier_rocaps_vertex_data",
    "hit_object_get_cubic_bezier_vertex_data",
    "hit_object_get_cubic_bspline_rocaps_vertex_data",
    "hit_object_get_cubic_bspline_vertex_data",
    "hit_object_get_curve_parameter",
    "hit_object_get_gas_traversable_handle",
    "hit_object_get_hit_kind",
    "hit_object_get_instance_id",
    "hit_object_get_instance_index",
    "hit_object_get_linear_curve_vertex_data",
    "hit_object_get_object_to_world_transform_matrix",
    "hit_object_get_primitive_index",
    "hit_object_get_quadratic_bspline_rocaps_vertex_data",
    "hit_object_get_quadratic_bspline_vertex_data",
    "hit_object_get_ray_flags",
    "hit_object_get_ray_time",
    "hit_object_get_ray_tmax",
    "hit_object_get_ray_tmin",
    "hit_object_get_ribbon_normal",
    "hit_object_get_ribbon_parameters",
    "hit_object_get_ribbon_vertex_data",
    "hit_object_get_sbt_data",
    "hit_object_get_sbt_gas_index",
    "hit_object_get_sbt_record_index",
    "hit_object_get_sphere_data",
    "hit_object_get_transform_list_handle",
    "hit_object_get_transform_list_size",
    "hit_object_get_traverse_data",
    "hit_object_get_triangle_barycentrics",
    "hit_object_get_triangle_vertex_data",
    "hit_object_get_world_ray_direction",
    "hit_object_get_world_ray_origin",
    "hit_object_get_world_to_object_transform_matrix",
    "hit_object_is_hit",
    "hit_object_is_miss",
    "hit_object_is_nop",
    "hit_object_set_sbt_record_index",
    "hit_object_transform_normal_from_object_to_world_space",
    "hit_object_transform_normal_from_world_to_object_space",
    "hit_object_transform_point_from_object_to_world_space",
    "hit_object_transform_point_from_world_to_object_space",
    "hit_object_transform_vector_from_object_to_world_space",
    "hit_object_transform_vector_from_world_to_object_space",
    "hypot",
    "ignore_intersection",
    "int_as_float",
    "inverse",
    "invoke",
    "is_back_face_hit",
    "is_front_face_hit",
    "is_triangle_back_face_hit",
    "is_triangle_front_face_hit",
    "is_triangle_hit",
    "isfinite",
    "isinf",
    "isnan",
    "length",
    "length_squared",
    "lerp",
    "log",
    "log2",
    "log10",
    "make_hit_object",
    "make_hit_object_with_record",
    "make_miss_hit_object",
    "make_nop_hit_object",
    "max",
    "min",
    "mix",
    "mul_hi",
    "normalize",
    "popcount",
    "pow",
    "radians",
    "reflect",
    "refract",
    "reorder",
    "report_intersection",
    "reverse_bits",
    "rint",
    "round",
    "rsqrt",
    "saturate",
    "set_payload_0",
    "set_payload_1",
    "set_payload_2",
    "set_payload_3",
    "set_payload_4",
    "set_payload_5",
    "set_payload_6",
    "set_payload_7",
    "set_payload_8",
    "set_payload_9",
    "set_payload_10",
    "set_payload_11",
    "set_payload_12",
    "set_payload_13",
    "set_payload_14",
    "set_payload_15",
    "set_payload_16",
    "set_payload_17",
    "set_payload_18",
    "set_payload_19",
    "set_payload_20",
    "set_payload_21",
    "set_payload_22",
    "set_payload_23",
    "set_payload_24",
    "set_payload_25",
    "set_payload_26",
    "set_payload_27",
    "set_payload_28",
    "set_payload_29",
    "set_payload_30",
    "set_payload_31",
    "set_payload_types",
    "sign",
    "sin",
    "sinh",
    "smoothstep",
    "sqrt",
    "step",
    "tan",
    "tanh",
    "terminate_ray",
    "tex2d",
    "throw_exception",
    "trace",
    "transform_normal_from_object_to_world_space",
    "transform_normal_from_world_to_object_space",
    "transform_point_from_object_to_world_space",
    "transform_point_from_world_to_object_space",
    "transform_vector_from_object_to_world_space",
    "transform_vector_from_world_to_object_space",
    "transpose",
    "traverse",
    "trunc",
    "uint_as_float",
    "undefined_value",
]
def get_launch_index() -> uint3:
    """The index of this invocation."""

def get_launch_dimensions() -> uint3:
    """Width, height and depth of the launch."""

def undefined_value() -> int:
    """An unspecified word, to end the life of a payload word cheaply."""

def terminate_ray() -> None:
    """Accept this hit and end the traversal."""

def ignore_intersection() -> None:
    """Drop this hit and go on."""

def set_payload_types(type_ids: int) -> None:
    """Which payload types this program takes; a constant, the first statement."""

def get_world_ray_origin() -> float3:
    """The origin passed to trace."""

def get_world_ray_direction() -> float3:
    """The direction passed to trace."""

def get_object_ray_origin() -> float3:
    """The origin in the current object space."""

def get_object_ray_direction() -> float3:
    """The direction in the current object space, not normalised."""

def get_ray_tmin() -> float:
    """tmin passed to trace."""

def get_ray_tmax() -> float:
    """Closest hit so far; any-hit: the candidate's distance; miss: tmax of trace."""

def get_ray_time() -> float:
    """The ray's time, 0 without motion."""

def get_ray_flags() -> int:
    """Flags passed to trace, 16 bits."""

def get_ray_visibility_mask() -> int:
    """Mask passed to trace, 8 bits."""

def get_payload_0() -> int:
    """Word 0 of the ray's payload."""

def set_payload_0(value: int) -> None:
    """Write word 0 of the ray's payload."""

def get_payload_1() -> int:
    """Word 1 of the ray's payload."""

def set_payload_1(value: int) -> None:
    """Write word 1 of the ray's payload."""

def get_payload_2() -> int:
    """Word 2 of the ray's payload."""

def set_payload_2(value: int) -> None:
    """Write word 2 of the ray's payload."""

def get_payload_3() -> int:
    """Word 3 of the ray's payload."""

def set_payload_3(value: int) -> None:
    """Write word 3 of the ray's payload."""

def get_payload_4() -> int:
    """Word 4 of the ray's payload."""

def set_payload_4(value: int) -> None:
    """Write word 4 of the ray's payload."""

def get_payload_5() -> int:
    """Word 5 of the ray's payload."""

def set_payload_5(value: int) -> None:
    """Write word 5 of the ray's payload."""

def get_payload_6() -> int:
    """Word 6 of the ray's payload."""

def set_payload_6(value: int) -> None:
    """Write word 6 of the ray's payload."""

def get_payload_7() -> int:
    """Word 7 of the ray's payload."""

def set_payload_7(value: int) -> None:
    """Write word 7 of the ray's payload."""

def get_payload_8() -> int:
    """Word 8 of the ray's payload."""

def set_payload_8(value: int) -> None:
    """Write word 8 of the ray's payload."""

def get_payload_9() -> int:
    """Word 9 of the ray's payload."""

def set_payload_9(value: int) -> None:
    """Write word 9 of the ray's payload."""

def get_payload_10() -> int:
    """Word 10 of the ray's payload."""

def set_payload_10(value: int) -> None:
    """Write word 10 of the ray's payload."""

def get_payload_11() -> int:
    """Word 11 of the ray's payload."""

def set_payload_11(value: int) -> None:
    """Write word 11 of the ray's payload."""

def get_payload_12() -> int:
    """Word 12 of the ray's payload."""

def set_payload_12(value: int) -> None:
    """Write word 12 of the ray's payload."""

def get_payload_13() -> int:
    """Word 13 of the ray's payload."""

def set_payload_13(value: int) -> None:
    """Write word 13 of the ray's payload."""

def get_payload_14() -> int:
    """Word 14 of the ray's payload."""

def set_payload_14(value: int) -> None:
    """Write word 14 of the ray's payload."""

def get_payload_15() -> int:
    """Word 15 of the ray's payload."""

def set_payload_15(value: int) -> None:
    """Write word 15 of the ray's payload."""

def get_payload_16() -> int:
    """Word 16 of the ray's payload."""

def set_payload_16(value: int) -> None:
    """Write word 16 of the ray's payload."""

def get_payload_17() -> int:
    """Word 17 of the ray's payload."""

def set_payload_17(value: int) -> None:
    """Write word 17 of the ray's payload."""

def get_payload_18() -> int:
    """Word 18 of the ray's payload."""

def set_payload_18(value: int) -> None:
    """Write word 18 of the ray's payload."""

def get_payload_19() -> int:
    """Word 19 of the ray's payload."""

def set_payload_19(value: int) -> None:
    """Write word 19 of the ray's payload."""

def get_payload_20() -> int:
    """Word 20 of the ray's payload."""

def set_payload_20(value: int) -> None:
    """Write word 20 of the ray's payload."""

def get_payload_21() -> int:
    """Word 21 of the ray's payload."""

def set_payload_21(value: int) -> None:
    """Write word 21 of the ray's payload."""

def get_payload_22() -> int:
    """Word 22 of the ray's payload."""

def set_payload_22(value: int) -> None:
    """Write word 22 of the ray's payload."""

def get_payload_23() -> int:
    """Word 23 of the ray's payload."""

def set_payload_23(value: int) -> None:
    """Write word 23 of the ray's payload."""

def get_payload_24() -> int:
    """Word 24 of the ray's payload."""

def set_payload_24(value: int) -> None:
    """Write word 24 of the ray's payload."""

def get_payload_25() -> int:
    """Word 25 of the ray's payload."""

def set_payload_25(value: int) -> None:
    """Write word 25 of the ray's payload."""

def get_payload_26() -> int:
    """Word 26 of the ray's payload."""

def set_payload_26(value: int) -> None:
    """Write word 26 of the ray's payload."""

def get_payload_27() -> int:
    """Word 27 of the ray's payload."""

def set_payload_27(value: int) -> None:
    """Write word 27 of the ray's payload."""

def get_payload_28() -> int:
    """Word 28 of the ray's payload."""

def set_payload_28(value: int) -> None:
    """Write word 28 of the ray's payload."""

def get_payload_29() -> int:
    """Word 29 of the ray's payload."""

def set_payload_29(value: int) -> None:
    """Write word 29 of the ray's payload."""

def get_payload_30() -> int:
    """Word 30 of the ray's payload."""

def set_payload_30(value: int) -> None:
    """Write word 30 of the ray's payload."""

def get_payload_31() -> int:
    """Word 31 of the ray's payload."""

def set_payload_31(value: int) -> None:
    """Write word 31 of the ray's payload."""

def get_attribute_0() -> int:
    """Word 0 of the hit's attributes."""

def get_attribute_1() -> int:
    """Word 1 of the hit's attributes."""

def get_attribute_2() -> int:
    """Word 2 of the hit's attributes."""

def get_attribute_3() -> int:
    """Word 3 of the hit's attributes."""

def get_attribute_4() -> int:
    """Word 4 of the hit's attributes."""

def get_attribute_5() -> int:
    """Word 5 of the hit's attributes."""

def get_attribute_6() -> int:
    """Word 6 of the hit's attributes."""

def get_attribute_7() -> int:
    """Word 7 of the hit's attributes."""

def get_exception_code() -> int:
    """Code of the exception."""

def get_exception_detail_0() -> int:
    """Detail 0 of a user exception."""

def get_exception_detail_1() -> int:
    """Detail 1 of a user exception."""

def get_exception_detail_2() -> int:
    """Detail 2 of a user exception."""

def get_exception_detail_3() -> int:
    """Detail 3 of a user exception."""

def get_exception_detail_4() -> int:
    """Detail 4 of a user exception."""

def get_exception_detail_5() -> int:
    """Detail 5 of a user exception."""

def get_exception_detail_6() -> int:
    """Detail 6 of a user exception."""

def get_exception_detail_7() -> int:
    """Detail 7 of a user exception."""

def get_primitive_index() -> int:
    """Index in the build input, plus its offset."""

def get_sbt_gas_index() -> int:
    """SBT index inside the geometry acceleration structure."""

def get_instance_id() -> int:
    """The instance's id, all ones without instance."""

def get_instance_index() -> int:
    """The instance's index in its parent, 0 without instance."""

def get_gas_traversable_handle() -> Traversable:
    """The geometry acceleration structure that was hit."""

def get_hit_kind() -> int:
    """8 bits: 0xFE and 0xFF for front and back of triangles, else as reported."""

@overload
def get_primitive_type() -> int: ...
@overload
def get_primitive_type(hit_kind: int) -> int:
    """The type of the primitive that was hit, one of ox.PrimitiveType."""

@overload
def is_front_face_hit() -> bool: ...
@overload
def is_front_face_hit(hit_kind: int) -> bool:
    """Whether the front of a built-in primitive was hit."""

@overload
def is_back_face_hit() -> bool: ...
@overload
def is_back_face_hit(hit_kind: int) -> bool:
    """Whether the back of a built-in primitive was hit."""

def is_triangle_hit() -> bool:
    """Whether a triangle was hit."""

def is_triangle_front_face_hit() -> bool:
    """Whether the front of a triangle was hit."""

def is_triangle_back_face_hit() -> bool:
    """Whether the back of a triangle was hit."""

def get_triangle_barycentrics() -> float2:
    """(u, v) with P = (1 - u - v) v0 + u v1 + v v2."""

def get_curve_parameter() -> float:
    """u along the curve segment."""

def get_ribbon_parameters() -> float2:
    """u along the axis, v across in [-1, 1]."""

def get_cluster_id() -> int:
    """The cluster's id, all ones outside of clusters."""

def get_transform_list_size() -> int:
    """Number of transforms above the primitive."""

def get_object_to_world_transform_matrix() -> float3x4:
    """Object to world at the ray's time."""

def get_world_to_object_transform_matrix() -> float3x4:
    """World to object at the ray's time."""

def get_geometric_normal() -> float3:
    """Not in OptiX: the normal in object space as the traversal found it, at no cost. Not of unit length; of triangles (p1 - p0) x (p2 - p0) but for rounding, of spheres and curves outward, of custom primitives 0."""

@overload
def get_triangle_vertex_data() -> tuple[float3, float3, float3]: ...
@overload
def get_triangle_vertex_data(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float3, float3, float3]:
    """Object-space vertices of the triangle at the ray's time."""

def get_triangle_vertex_data_from_handle(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float3, float3, float3]:
    """Object-space vertices of the triangle at the ray's time."""

@overload
def get_linear_curve_vertex_data() -> tuple[float4, float4]: ...
@overload
def get_linear_curve_vertex_data(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4]:
    """Control points of the linear segment, radius in w."""

def get_linear_curve_vertex_data_from_handle(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4]:
    """Control points of the linear segment, radius in w."""

@overload
def get_quadratic_bspline_vertex_data() -> tuple[float4, float4, float4]: ...
@overload
def get_quadratic_bspline_vertex_data(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4]:
    """Control points of the quadratic B-spline, radius in w."""

def get_quadratic_bspline_vertex_data_from_handle(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4]:
    """Control points of the quadratic B-spline, radius in w."""

@overload
def get_quadratic_bspline_rocaps_vertex_data() -> tuple[float4, float4, float4]: ...
@overload
def get_quadratic_bspline_rocaps_vertex_data(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4]:
    """Control points of the quadratic B-spline, radius in w."""

def get_quadratic_bspline_rocaps_vertex_data_from_handle(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4]:
    """Control points of the quadratic B-spline, radius in w."""

@overload
def get_cubic_bspline_vertex_data() -> tuple[float4, float4, float4, float4]: ...
@overload
def get_cubic_bspline_vertex_data(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4, float4]:
    """Control points of the cubic B-spline, radius in w."""

def get_cubic_bspline_vertex_data_from_handle(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4, float4]:
    """Control points of the cubic B-spline, radius in w."""

@overload
def get_cubic_bspline_rocaps_vertex_data() -> tuple[float4, float4, float4, float4]: ...
@overload
def get_cubic_bspline_rocaps_vertex_data(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4, float4]:
    """Control points of the cubic B-spline, radius in w."""

def get_cubic_bspline_rocaps_vertex_data_from_handle(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4, float4]:
    """Control points of the cubic B-spline, radius in w."""

@overload
def get_catmull_rom_vertex_data() -> tuple[float4, float4, float4, float4]: ...
@overload
def get_catmull_rom_vertex_data(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4, float4]:
    """Control points of the Catmull-Rom segment, radius in w."""

def get_catmull_rom_vertex_data_from_handle(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4, float4]:
    """Control points of the Catmull-Rom segment, radius in w."""

@overload
def get_catmull_rom_rocaps_vertex_data() -> tuple[float4, float4, float4, float4]: ...
@overload
def get_catmull_rom_rocaps_vertex_data(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4, float4]:
    """Control points of the Catmull-Rom segment, radius in w."""

def get_catmull_rom_rocaps_vertex_data_from_handle(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4, float4]:
    """Control points of the Catmull-Rom segment, radius in w."""

@overload
def get_cubic_bezier_vertex_data() -> tuple[float4, float4, float4, float4]: ...
@overload
def get_cubic_bezier_vertex_data(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4, float4]:
    """Control points of the Bezier segment, radius in w."""

def get_cubic_bezier_vertex_data_from_handle(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4, float4]:
    """Control points of the Bezier segment, radius in w."""

@overload
def get_cubic_bezier_rocaps_vertex_data() -> tuple[float4, float4, float4, float4]: ...
@overload
def get_cubic_bezier_rocaps_vertex_data(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4, float4]:
    """Control points of the Bezier segment, radius in w."""

def get_cubic_bezier_rocaps_vertex_data_from_handle(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4, float4]:
    """Control points of the Bezier segment, radius in w."""

@overload
def get_ribbon_vertex_data() -> tuple[float4, float4, float4]: ...
@overload
def get_ribbon_vertex_data(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4]:
    """Control points of the ribbon's axis, half width in w."""

def get_ribbon_vertex_data_from_handle(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> tuple[float4, float4, float4]:
    """Control points of the ribbon's axis, half width in w."""

@overload
def get_sphere_data() -> float4: ...
@overload
def get_sphere_data(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> float4:
    """Centre and radius of the sphere."""

def get_sphere_data_from_handle(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float) -> float4:
    """Centre and radius of the sphere."""

def get_transform_list_handle(index: int) -> Traversable:
    """Transform `index`, 0 outermost."""

def transform_point_from_world_to_object_space(value: float3) -> float3:
    """Through the transform list; not normalised."""

def transform_point_from_object_to_world_space(value: float3) -> float3:
    """Through the transform list; not normalised."""

def transform_vector_from_world_to_object_space(value: float3) -> float3:
    """Through the transform list; not normalised."""

def transform_vector_from_object_to_world_space(value: float3) -> float3:
    """Through the transform list; not normalised."""

def transform_normal_from_world_to_object_space(value: float3) -> float3:
    """Through the transform list; not normalised."""

def transform_normal_from_object_to_world_space(value: float3) -> float3:
    """Through the transform list; not normalised."""

def get_ribbon_normal(parameters: float2) -> float3:
    """Geometric normal of the ribbon."""

def get_ribbon_normal_from_handle(gas: Traversable, primitive_index: int, sbt_gas_index: int, time: float, parameters: float2) -> float3:
    """Geometric normal of a ribbon."""

def get_transform_type_from_handle(handle: Traversable) -> int:
    """One of ox.TransformType."""

def get_instance_id_from_handle(handle: Traversable) -> int:
    """The id of an instance handle, 0 for others."""

def get_instance_child_from_handle(handle: Traversable) -> Traversable:
    """The child of an instance handle, 0 for others."""

def get_instance_transform_from_handle(handle: Traversable) -> float3x4:
    """Object to world of an instance handle, zero for others."""

def get_instance_inverse_transform_from_handle(handle: Traversable) -> float3x4:
    """World to object of an instance handle, zero for others."""

def get_gas_motion_time_begin(handle: Traversable) -> float:
    """First time of the structure's motion keys."""

def get_gas_motion_time_end(handle: Traversable) -> float:
    """Last time of the structure's motion keys."""

def get_gas_motion_step_count(handle: Traversable) -> int:
    """Number of the structure's motion keys."""

def get_gas_pointer_from_handle(handle: Traversable) -> int:
    """An address that no other structure has; 0 for other handles."""

def get_instance_traversable_from_ias(ias: Traversable, index: int) -> Traversable:
    """The handle of an instance; the structure must allow random instance access."""

def get_static_transform_from_handle(handle: Traversable) -> tuple[Traversable, float3x4, float3x4]:
    """Child, matrix and inverse of a static transform; zeros for other handles."""

def get_matrix_motion_transform_from_handle(handle: Traversable, key: int) -> tuple[Traversable, int, int, float, float, float3x4]:
    """Child, number of keys, flags, begin, end and one key of a matrix-motion transform; zeros for other handles."""

def get_srt_motion_transform_from_handle(handle: Traversable, key: int) -> tuple[Traversable, int, int, float, float, float4x4]:
    """Child, number of keys, flags, begin, end and the 16 numbers of one key of an SRT-motion transform; zeros for other handles."""

def hit_object_is_hit() -> bool:
    """Outgoing hit object: Whether it is a hit."""

def hit_object_is_miss() -> bool:
    """Outgoing hit object: Whether it is a miss."""

def hit_object_is_nop() -> bool:
    """Outgoing hit object: Whether it is a nop."""

def hit_object_get_sbt_record_index() -> int:
    """Outgoing hit object: The record that invoke would use."""

def hit_object_get_gas_traversable_handle() -> Traversable:
    """Outgoing hit object: The geometry acceleration structure, 0 if not a hit."""

def hit_object_get_world_ray_origin() -> float3:
    """Outgoing hit object: The ray's origin."""

def hit_object_get_world_ray_direction() -> float3:
    """Outgoing hit object: The ray's direction."""

def hit_object_get_ray_tmin() -> float:
    """Outgoing hit object: The ray's tmin."""

def hit_object_get_ray_tmax() -> float:
    """Outgoing hit object: The hit's distance, or tmax of a miss."""

def hit_object_get_ray_time() -> float:
    """Outgoing hit object: The ray's time."""

def hit_object_get_ray_flags() -> int:
    """Outgoing hit object: The ray's flags."""

def hit_object_get_world_to_object_transform_matrix() -> float3x4:
    """Outgoing hit object: World to object at the ray's time."""

def hit_object_get_object_to_world_transform_matrix() -> float3x4:
    """Outgoing hit object: Object to world at the ray's time."""

def hit_object_get_transform_list_size() -> int:
    """Outgoing hit object: Number of transforms; 0 for miss and nop."""

def hit_object_get_cluster_id() -> int:
    """Outgoing hit object: The cluster's id, all ones outside of clusters."""

def hit_object_get_primitive_index() -> int:
    """Outgoing hit object: The primitive's index."""

def hit_object_get_sbt_gas_index() -> int:
    """Outgoing hit object: SBT index inside the geometry acceleration structure."""

def hit_object_get_instance_id() -> int:
    """Outgoing hit object: The instance's id."""

def hit_object_get_instance_index() -> int:
    """Outgoing hit object: The instance's index."""

def hit_object_get_hit_kind() -> int:
    """Outgoing hit object: The hit kind."""

def hit_object_get_triangle_barycentrics() -> float2:
    """Outgoing hit object: (u, v) of a triangle."""

def hit_object_get_curve_parameter() -> float:
    """Outgoing hit object: u of a curve."""

def hit_object_get_ribbon_parameters() -> float2:
    """Outgoing hit object: (u, v) of a ribbon."""

def hit_object_get_attribute_0() -> int:
    """Outgoing hit object: Word 0 of the attributes."""

def hit_object_get_attribute_1() -> int:
    """Outgoing hit object: Word 1 of the attributes."""

def hit_object_get_attribute_2() -> int:
    """Outgoing hit object: Word 2 of the attributes."""

def hit_object_get_attribute_3() -> int:
    """Outgoing hit object: Word 3 of the attributes."""

def hit_object_get_attribute_4() -> int:
    """Outgoing hit object: Word 4 of the attributes."""

def hit_object_get_attribute_5() -> int:
    """Outgoing hit object: Word 5 of the attributes."""

def hit_object_get_attribute_6() -> int:
    """Outgoing hit object: Word 6 of the attributes."""

def hit_object_get_attribute_7() -> int:
    """Outgoing hit object: Word 7 of the attributes."""

def hit_object_get_triangle_vertex_data() -> tuple[float3, float3, float3]:
    """Outgoing hit object: Object-space vertices of the triangle at the ray's time."""

def hit_object_get_linear_curve_vertex_data() -> tuple[float4, float4]:
    """Outgoing hit object: Control points of the linear segment, radius in w."""

def hit_object_get_quadratic_bspline_vertex_data() -> tuple[float4, float4, float4]:
    """Outgoing hit object: Control points of the quadratic B-spline, radius in w."""

def hit_object_get_quadratic_bspline_rocaps_vertex_data() -> tuple[float4, float4, float4]:
    """Outgoing hit object: Control points of the quadratic B-spline, radius in w."""

def hit_object_get_cubic_bspline_vertex_data() -> tuple[float4, float4, float4, float4]:
    """Outgoing hit object: Control points of the cubic B-spline, radius in w."""

def hit_object_get_cubic_bspline_rocaps_vertex_data() -> tuple[float4, float4, float4, float4]:
    """Outgoing hit object: Control points of the cubic B-spline, radius in w."""

def hit_object_get_catmull_rom_vertex_data() -> tuple[float4, float4, float4, float4]:
    """Outgoing hit object: Control points of the Catmull-Rom segment, radius in w."""

def hit_object_get_catmull_rom_rocaps_vertex_data() -> tuple[float4, float4, float4, float4]:
    """Outgoing hit object: Control points of the Catmull-Rom segment, radius in w."""

def hit_object_get_cubic_bezier_vertex_data() -> tuple[float4, float4, float4, float4]:
    """Outgoing hit object: Control points of the Bezier segment, radius in w."""

def hit_object_get_cubic_bezier_rocaps_vertex_data() -> tuple[float4, float4, float4, float4]:
    """Outgoing hit object: Control points of the Bezier segment, radius in w."""

def hit_object_get_ribbon_vertex_data() -> tuple[float4, float4, float4]:
    """Outgoing hit object: Control points of the ribbon's axis, half width in w."""

def hit_object_get_sphere_data() -> float4:
    """Outgoing hit object: Centre and radius of the sphere."""

def hit_object_transform_point_from_world_to_object_space(value: float3) -> float3:
    """Through the outgoing hit object's transforms; not normalised."""

def hit_object_transform_point_from_object_to_world_space(value: float3) -> float3:
    """Through the outgoing hit object's transforms; not normalised."""

def hit_object_transform_vector_from_world_to_object_space(value: float3) -> float3:
    """Through the outgoing hit object's transforms; not normalised."""

def hit_object_transform_vector_from_object_to_world_space(value: float3) -> float3:
    """Through the outgoing hit object's transforms; not normalised."""

def hit_object_transform_normal_from_world_to_object_space(value: float3) -> float3:
    """Through the outgoing hit object's transforms; not normalised."""

def hit_object_transform_normal_from_object_to_world_space(value: float3) -> float3:
    """Through the outgoing hit object's transforms; not normalised."""

def hit_object_get_traverse_data() -> Any:
    """The hit as words that make_hit_object takes."""

def hit_object_get_transform_list_handle(index: int) -> Traversable:
    """Outgoing hit object: transform `index`, 0 outermost."""

def hit_object_get_ribbon_normal(parameters: float2) -> float3:
    """Outgoing hit object: geometric normal of the ribbon."""

@overload
def make_hit_object(handle: Traversable, origin: float3, direction: float3, tmin: float, ray_time: float, ray_flags: int, traverse_data: Any, transforms: Any, num_transforms: int) -> None: ...
@overload
def make_hit_object(handle: Traversable, origin: float3, direction: float3, tmin: float, tmax: float, ray_time: float, sbt_offset: int, sbt_stride: int, instance_index: int, sbt_gas_index: int, primitive_index: int, hit_kind: int, attribute_0: int = ..., attribute_1: int = ..., attribute_2: int = ..., attribute_3: int = ..., attribute_4: int = ..., attribute_5: int = ..., attribute_6: int = ..., attribute_7: int = ...) -> None: ...
@overload
def make_hit_object(handle: Traversable, origin: float3, direction: float3, tmin: float, tmax: float, ray_time: float, sbt_offset: int, sbt_stride: int, instance_index: int, transforms: Any, num_transforms: int, sbt_gas_index: int, primitive_index: int, hit_kind: int, attribute_0: int = ..., attribute_1: int = ..., attribute_2: int = ..., attribute_3: int = ..., attribute_4: int = ..., attribute_5: int = ..., attribute_6: int = ..., attribute_7: int = ...) -> None:
    """Make the outgoing hit object the hit that the traverse data of an earlier one tell, below these transforms."""

def make_hit_object_with_record(handle: Traversable, origin: float3, direction: float3, tmin: float, tmax: float, ray_time: float, sbt_record_index: int, instance_index: int, transforms: Any, num_transforms: int, sbt_gas_index: int, primitive_index: int, hit_kind: int, attribute_0: int = ..., attribute_1: int = ..., attribute_2: int = ..., attribute_3: int = ..., attribute_4: int = ..., attribute_5: int = ..., attribute_6: int = ..., attribute_7: int = ...) -> None:
    """Make the outgoing hit object a hit at tmax of this primitive with this record (OptiX 8)."""

def make_miss_hit_object(miss_sbt_index: int, origin: float3, direction: float3, tmin: float, tmax: float, ray_time: float = ..., ray_flags: int = ...) -> None:
    """Make the outgoing hit object a miss."""

def make_nop_hit_object() -> None:
    """Make the outgoing hit object a nop."""

def hit_object_set_sbt_record_index(index: int) -> None:
    """Choose the record that invoke uses."""

def reorder(coherence_hint: int = ..., num_coherence_hint_bits: int = ...) -> None:
    """Ask for threads to be grouped by hit object and hint; never changes results."""

@overload
def sqrt(x: float) -> float: ...
@overload
def sqrt(x: _V) -> _V:
    """Square root."""

@overload
def rsqrt(x: float) -> float: ...
@overload
def rsqrt(x: _V) -> _V:
    """1 / sqrt(x)."""

@overload
def sin(x: float) -> float: ...
@overload
def sin(x: _V) -> _V:
    """Sine of an angle in radians."""

@overload
def cos(x: float) -> float: ...
@overload
def cos(x: _V) -> _V:
    """Cosine of an angle in radians."""

@overload
def tan(x: float) -> float: ...
@overload
def tan(x: _V) -> _V:
    """Tangent of an angle in radians."""

@overload
def asin(x: float) -> float: ...
@overload
def asin(x: _V) -> _V:
    """Arc sine in radians."""

@overload
def acos(x: float) -> float: ...
@overload
def acos(x: _V) -> _V:
    """Arc cosine in radians."""

@overload
def atan(x: float) -> float: ...
@overload
def atan(x: _V) -> _V:
    """Arc tangent in radians."""

@overload
def sinh(x: float) -> float: ...
@overload
def sinh(x: _V) -> _V:
    """Hyperbolic sine."""

@overload
def cosh(x: float) -> float: ...
@overload
def cosh(x: _V) -> _V:
    """Hyperbolic cosine."""

@overload
def tanh(x: float) -> float: ...
@overload
def tanh(x: _V) -> _V:
    """Hyperbolic tangent."""

@overload
def exp(x: float) -> float: ...
@overload
def exp(x: _V) -> _V:
    """e to the power of x."""

@overload
def exp2(x: float) -> float: ...
@overload
def exp2(x: _V) -> _V:
    """2 to the power of x."""

@overload
def log(x: float) -> float: ...
@overload
def log(x: _V) -> _V:
    """Natural logarithm."""

@overload
def log2(x: float) -> float: ...
@overload
def log2(x: _V) -> _V:
    """Logarithm to base 2."""

@overload
def log10(x: float) -> float: ...
@overload
def log10(x: _V) -> _V:
    """Logarithm to base 10."""

@overload
def floor(x: float) -> float: ...
@overload
def floor(x: _V) -> _V:
    """The largest whole number not above x, as a float."""

@overload
def ceil(x: float) -> float: ...
@overload
def ceil(x: _V) -> _V:
    """The smallest whole number not below x, as a float."""

@overload
def trunc(x: float) -> float: ...
@overload
def trunc(x: _V) -> _V:
    """x without its fraction."""

@overload
def round(x: float) -> float: ...
@overload
def round(x: _V) -> _V:
    """The nearest whole number, halves to even, as a float."""

@overload
def fract(x: float) -> float: ...
@overload
def fract(x: _V) -> _V:
    """x - floor(x)."""

@overload
def saturate(x: float) -> float: ...
@overload
def saturate(x: _V) -> _V:
    """x limited to [0, 1]."""

@overload
def radians(x: float) -> float: ...
@overload
def radians(x: _V) -> _V:
    """Degrees to radians."""

@overload
def degrees(x: float) -> float: ...
@overload
def degrees(x: _V) -> _V:
    """Radians to degrees."""

@overload
def rint(x: float) -> float: ...
@overload
def rint(x: _V) -> _V:
    """The nearest whole number, halves to even, as a float."""

@overload
def atan2(y: float, x: float) -> float: ...
@overload
def atan2(y: _V | float, x: _V | float) -> _V:
    """Angle of the point (x, y) in radians."""

@overload
def pow(x: float, y: float) -> float: ...
@overload
def pow(x: _V | float, y: _V | float) -> _V:
    """x to the power of y."""

@overload
def fmod(x: float, y: float) -> float: ...
@overload
def fmod(x: _V | float, y: _V | float) -> _V:
    """Remainder of C: it has the sign of x."""

@overload
def hypot(x: float, y: float) -> float: ...
@overload
def hypot(x: _V | float, y: _V | float) -> _V:
    """sqrt(x*x + y*y) without overflow."""

@overload
def copysign(x: float, sign: float) -> float: ...
@overload
def copysign(x: _V | float, sign: _V | float) -> _V:
    """x with the sign of the other."""

@overload
def fma(a: float, b: float, c: float) -> float: ...
@overload
def fma(a: _V | float, b: _V | float, c: _V | float) -> _V:
    """a * b + c, rounded once."""

@overload
def lerp(a: float, b: float, t: float) -> float: ...
@overload
def lerp(a: _V | float, b: _V | float, t: _V | float) -> _V:
    """a + t * (b - a)."""

@overload
def mix(a: float, b: float, t: float) -> float: ...
@overload
def mix(a: _V | float, b: _V | float, t: _V | float) -> _V:
    """The same as lerp."""

@overload
def step(edge: float, x: float) -> float: ...
@overload
def step(edge: _V | float, x: _V | float) -> _V:
    """0 below the edge, else 1."""

@overload
def smoothstep(edge0: float, edge1: float, x: float) -> float: ...
@overload
def smoothstep(edge0: _V | float, edge1: _V | float, x: _V | float) -> _V:
    """Hermite step between two edges."""

@overload
def isnan(x: float) -> bool: ...
@overload
def isnan(x: _V) -> Any:
    """Whether x is not a number."""

@overload
def isinf(x: float) -> bool: ...
@overload
def isinf(x: _V) -> Any:
    """Whether x is infinite."""

@overload
def isfinite(x: float) -> bool: ...
@overload
def isfinite(x: _V) -> Any:
    """Whether x is neither infinite nor NaN."""

@overload
def abs(x: int) -> int: ...
@overload
def abs(x: float) -> float: ...
@overload
def abs(x: _V) -> _V:
    """Absolute value."""

@overload
def sign(x: int) -> int: ...
@overload
def sign(x: float) -> float: ...
@overload
def sign(x: _V) -> _V:
    """-1, 0 or 1."""

@overload
def min(a: int, b: int) -> int: ...
@overload
def min(a: float, b: float) -> float: ...
@overload
def min(a: _V | float, b: _V | float) -> _V:
    """The smaller: a if a < b else b."""

@overload
def max(a: int, b: int) -> int: ...
@overload
def max(a: float, b: float) -> float: ...
@overload
def max(a: _V | float, b: _V | float) -> _V:
    """The larger: a if a > b else b."""

@overload
def clamp(x: int, low: int, high: int) -> int: ...
@overload
def clamp(x: float, low: float, high: float) -> float: ...
@overload
def clamp(x: _V | float, low: _V | float, high: _V | float) -> _V:
    """max(low, min(x, high))."""

def dot(a: _V, b: _V) -> float:
    """Scalar product."""

def cross(a: float3, b: float3) -> float3:
    """Vector product."""

def length(v: _V) -> float:
    """Euclidean length."""

def length_squared(v: _V) -> float:
    """Square of the Euclidean length."""

def distance(a: _V, b: _V) -> float:
    """Length of a - b."""

def normalize(v: _V) -> _V:
    """v divided by its length."""

def reflect(i: _V, n: _V) -> _V:
    """i - 2 dot(n, i) n."""

def refract(i: _V, n: _V, eta: float) -> _V:
    """Direction after refraction, zero if there is none."""

def faceforward(n: _V, i: _V, reference: _V) -> _V:
    """n, turned against i."""

def float_as_uint(x: float) -> int:
    """The bits of a float."""

def float_as_int(x: float) -> int:
    """The bits of a float."""

def uint_as_float(x: int) -> float:
    """The float of these bits."""

def int_as_float(x: int) -> float:
    """The float of these bits."""

@overload
def popcount(x: int) -> int: ...
@overload
def popcount(x: _V) -> _V:
    """How many bits are set."""

@overload
def clz(x: int) -> int: ...
@overload
def clz(x: _V) -> _V:
    """How many zero bits stand above the highest set bit."""

@overload
def ctz(x: int) -> int: ...
@overload
def ctz(x: _V) -> _V:
    """How many zero bits stand below the lowest set bit."""

def reverse_bits(x: int) -> int:
    """Bit 0 becomes bit 31, and so on."""

def mul_hi(a: int, b: int) -> int:
    """The upper word of the 64-bit product."""

def transpose(m: float3x3) -> float3x3:
    """Rows become columns."""

def determinant(m: float3x3) -> float:
    """Determinant."""

def inverse(m: float3x3) -> float3x3:
    """Inverse; infinite or NaN where there is none."""

def tex2d(texture: Texture, u: float, v: float) -> float4:
    """The filtered texel at (u, v) in [0, 1]; missing channels are 0, alpha 1."""

def atomic_add(array: Any, index: int | tuple[int, ...], value: float) -> Any:
    """Add to an element; gives the value before."""

def atomic_sub(array: Any, index: int | tuple[int, ...], value: float) -> Any:
    """Subtract from an element; gives the value before."""

def atomic_exch(array: Any, index: int | tuple[int, ...], value: float) -> Any:
    """Replace an element; gives the value before."""

def atomic_min(array: Any, index: int | tuple[int, ...], value: float) -> Any:
    """Make an element the smaller of it and the value; gives the value before."""

def atomic_max(array: Any, index: int | tuple[int, ...], value: float) -> Any:
    """Make an element the larger of it and the value; gives the value before."""

def atomic_and(array: Any, index: int | tuple[int, ...], value: float) -> Any:
    """Bitwise and with an integer element; gives the value before."""

def atomic_or(array: Any, index: int | tuple[int, ...], value: float) -> Any:
    """Bitwise or with an integer element; gives the value before."""

def atomic_xor(array: Any, index: int | tuple[int, ...], value: float) -> Any:
    """Bitwise exclusive or with an integer element; gives the value before."""

def atomic_inc(array: Any, index: int | tuple[int, ...], value: float) -> Any:
    """Add 1, or go to 0 from the value on; gives the value before."""

def atomic_dec(array: Any, index: int | tuple[int, ...], value: float) -> Any:
    """Subtract 1, or go to the value from 0 and above it; gives the value before."""

def atomic_cas(array: Any, index: int | tuple[int, ...], compare: float, value: float) -> Any:
    """Replace an element by `value` if it is `compare`; gives the value before."""

def coop_vec_load(type: Any, array: Any, offset_in_bytes: int = ...) -> Any:
    """The vector of `type` that stands in an array, from this offset."""

def coop_vec_exp2(vector: Any) -> Any:
    """2 to the power of each element."""

def coop_vec_log2(vector: Any) -> Any:
    """Logarithm to base 2 of each element."""

def coop_vec_tanh(vector: Any) -> Any:
    """Hyperbolic tangent of each element."""

def coop_vec_cvt(type: Any, vector: Any) -> Any:
    """The elements as float16 or float32."""

def coop_vec_min(a: Any, b: Any) -> Any:
    """The smaller of each two elements."""

def coop_vec_max(a: Any, b: Any) -> Any:
    """The greater of each two elements."""

def coop_vec_mul(a: Any, b: Any) -> Any:
    """Product, element by element."""

def coop_vec_add(a: Any, b: Any) -> Any:
    """Sum, element by element."""

def coop_vec_sub(a: Any, b: Any) -> Any:
    """Difference, element by element."""

def coop_vec_step(a: Any, b: Any) -> Any:
    """0 where the element of b is below that of a, else 1."""

def coop_vec_ffma(a: Any, b: Any, c: Any) -> Any:
    """a * b + c, element by element, without rounding in between."""

def coop_vec_mat_mul(type: Any, vector: Any, matrix: Any, matrix_offset_in_bytes: int = ..., bias: Any = ..., bias_offset_in_bytes: int = ..., row_column_stride_in_bytes: int = ..., input_interpretation: int = ..., matrix_layout: int = ..., transpose: bool = ..., matrix_element_type: int = ..., bias_element_type: int = ...) -> Any:
    """matrix * vector + bias, as a vector of `type`; an element type that is UNKNOWN is that of the vector or result."""

def coop_vec_reduce_sum_accumulate(vector: Any, array: Any, offset_in_bytes: int = ...) -> None:
    """Add each element to the one in memory, atomically."""

def coop_vec_outer_product_accumulate(a: Any, b: Any, matrix: Any, offset_in_bytes: int = ..., matrix_layout: int = ...) -> None:
    """Add a * transpose(b) to the matrix in memory, atomically."""

def coop_vec_get_matrix_size(n: int, k: int, element_type: int, matrix_layout: int = ..., row_column_stride_in_bytes: int = ...) -> int:
    """Bytes of a matrix of n rows and k columns, a multiple of 64; a constant."""


@overload
def trace(handle: Traversable, origin: float3, direction: float3, tmin: float = ..., tmax: float = ..., ray_time: float = ..., visibility_mask: int = ..., ray_flags: int = ..., sbt_offset: int = ..., sbt_stride: int = ..., miss_sbt_index: int = ..., *, payload: _P) -> _P: ...
@overload
def trace(handle: Traversable, origin: float3, direction: float3, tmin: float = ..., tmax: float = ..., ray_time: float = ..., visibility_mask: int = ..., ray_flags: int = ..., sbt_offset: int = ..., sbt_stride: int = ..., miss_sbt_index: int = ..., *, payload: Any = ...) -> None:
    """Find the closest hit in [tmin, tmax], running intersection and any-hit programs, then run closest-hit or miss."""

@overload
def traverse(handle: Traversable, origin: float3, direction: float3, tmin: float = ..., tmax: float = ..., ray_time: float = ..., visibility_mask: int = ..., ray_flags: int = ..., sbt_offset: int = ..., sbt_stride: int = ..., miss_sbt_index: int = ..., *, payload: _P) -> _P: ...
@overload
def traverse(handle: Traversable, origin: float3, direction: float3, tmin: float = ..., tmax: float = ..., ray_time: float = ..., visibility_mask: int = ..., ray_flags: int = ..., sbt_offset: int = ..., sbt_stride: int = ..., miss_sbt_index: int = ..., *, payload: Any = ...) -> None:
    """Like trace without closest-hit and miss; the result is the outgoing hit object."""

def invoke(payload: _P | Any = ...) -> Any:
    """Run the program that the hit object chose, with this payload."""

def get_sbt_data(struct: type[_S]) -> _S:
    """The data of the current SBT record, as this struct."""

def hit_object_get_sbt_data(struct: type[_S]) -> _S:
    """The data of the hit object's SBT record, as this struct."""

def report_intersection(t: float, hit_kind: int, *attributes: Any) -> bool:
    """Offer a hit at distance t; attributes are a struct or up to 8 words. Whether it was accepted."""

def throw_exception(code: int, *details: float) -> None:
    """End the launch index and run the exception program."""

@overload
def direct_call(index: int, *args: Any, result: type[_S]) -> _S: ...
@overload
def direct_call(index: int, *args: Any) -> None:
    """Call the direct callable of this record; `result` names its type."""

@overload
def continuation_call(index: int, *args: Any, result: type[_S]) -> _S: ...
@overload
def continuation_call(index: int, *args: Any) -> None:
    """Call the continuation callable of this record; `result` names its type."""
