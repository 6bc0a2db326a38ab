"""Struct classes on the host: construction, conversion, checks, bytes that follow every change."""

from __future__ import annotations

import copy as python_copy
from typing import Any

import numpy as np
import pytest

import optixc as ox
from optixc import float3


@ox.struct
class Camera:
    eye: float3
    fov: float = 1.5


@ox.struct
class Params:
    image: ox.Array2[ox.float4]
    camera: Camera
    scene: ox.Traversable
    count: ox.uint32 = 7
    weights: ox.FixedArray[ox.float32, 2] = (0.5, 0.25)


def image(*shape: int) -> np.ndarray:
    return np.zeros(shape, np.float32)


def params(**changes: Any) -> Params:
    values = {"image": image(2, 3, 4), "camera": Camera((1, 2, 3)), "scene": 0, **changes}
    return Params(**values)


def row(value: Any) -> Any:
    return np.frombuffer(bytes(value.packed()), type(value).dtype)[0]


def test_construction_by_position_and_keyword_with_defaults() -> None:
    camera = Camera((1, 2, 3))
    assert camera.eye == float3(1, 2, 3)
    assert camera.fov == 1.5
    assert Camera(eye=float3(1), fov=2.0) == Camera(1, 2.0)


def test_arrays_are_not_copied() -> None:
    target = image(2, 3, 4)
    made = params(image=target)
    assert made.image is target
    packed = row(made)["image"]
    assert packed["data"] == target.ctypes.data
    assert tuple(packed["shape"]) == (2, 3)


def test_bytes_follow_changes_also_of_a_struct_inside() -> None:
    camera = Camera((1, 2, 3))
    made = params(camera=camera)
    camera.fov = 4.0
    made.count = 9
    assert row(made)["camera"]["fov"] == 4.0
    assert row(made)["count"] == 9
    made.camera = Camera((0, 0, 0), 1.0)
    camera.fov = 100.0
    assert row(made)["camera"]["fov"] == 1.0


def test_missing_unknown_and_doubled_fields_are_type_errors() -> None:
    with pytest.raises(TypeError, match="needs a value for image, camera"):
        Params(scene=0)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="has no field focus; it has eye, fov"):
        Camera(eye=0, focus=3)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="two values"):
        Camera((1, 2, 3), eye=0)  # type: ignore[misc]
    with pytest.raises(AttributeError, match="no field 'focus'"):
        Camera(0).focus = 3  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="a field of Camera cannot be deleted"):
        del Camera(0).fov


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("image", np.zeros((2, 3, 4)), r"astype\(numpy.float32\)"),
        ("image", image(2, 3, 3), r"shape \(n, m, 4\)"),
        ("image", image(3, 4), r"shape \(n, m, 4\)"),
        ("image", image(4, 3, 2).T, "ascontiguousarray"),
        ("image", image(4, 3, 4)[::2], "ascontiguousarray"),
        ("image", [[0.0]], "numpy array"),
        ("count", -1, "uint32"),
        ("count", 1.5, "uint32"),
        ("count", 1 << 32, "uint32"),
        ("scene", "world", "Traversable"),
        ("scene", -1, "Traversable"),
        ("weights", (1, 2, 3), "2 elements"),
        ("camera", 3, "Camera"),
    ],
)
def test_wrong_values_are_named(field: str, value: object, message: str) -> None:
    made = params()
    before = bytes(made.packed())
    with pytest.raises(ox.InvalidValueError, match=message) as caught:
        setattr(made, field, value)
    assert f"Params.{field}" in str(caught.value)
    assert bytes(made.packed()) == before


def test_struct_arrays_take_the_structs_dtype() -> None:
    @ox.struct
    class Scene:
        cameras: ox.Array[Camera]

    cameras = np.zeros(3, Camera.dtype)
    cameras["fov"] = 2.0
    assert row(Scene(cameras))["cameras"]["shape"][0] == 3
    with pytest.raises(ox.InvalidValueError, match="dtype of the struct"):
        Scene(np.zeros((3, 4), np.float32))


def test_fixed_arrays_hold_vectors_and_matrices() -> None:
    @ox.struct
    class Spline:
        knots: ox.FixedArray[ox.float3, 2]
        frames: ox.FixedArray[ox.float3x4, 2]

    spline = Spline([(1, 2, 3), (4, 5, 6)], np.arange(24).reshape(2, 3, 4))
    np.testing.assert_array_equal(row(spline)["knots"], [[1, 2, 3], [4, 5, 6]])
    np.testing.assert_array_equal(row(spline)["frames"], np.arange(24).reshape(2, 3, 4))
    assert Spline.nbytes == 4 * (6 + 24)
    with pytest.raises(ox.InvalidValueError, match=r"shape \(2, 3\)"):
        spline.knots = [1, 2, 3]


def test_a_list_of_structs_is_copied_into_an_array() -> None:
    @ox.struct
    class Mesh:
        weights: ox.Array[ox.float32]
        camera: Camera

    @ox.struct
    class Scene:
        meshes: ox.Array[Mesh]

    weights = [np.full(n, n, np.float32) for n in (2, 3)]
    addresses = [array.ctypes.data for array in weights]
    scene = Scene([Mesh(weights.pop(0), Camera((1, 2, 3), 4)), (weights.pop(0), Camera(0))])
    meshes: np.ndarray = scene.meshes
    assert meshes.dtype == Mesh.dtype
    assert row(scene)["meshes"]["data"] == meshes.ctypes.data
    assert list(meshes["weights"]["data"]) == addresses
    assert list(meshes["weights"]["shape"][:, 0]) == [2, 3]
    assert meshes[0]["camera"]["fov"] == 4.0
    # The originals' arrays are still there: nothing else holds them
    assert [list(source.weights) for source in meshes.sources] == [[2, 2], [3, 3, 3]]
    assert Scene([]).meshes.shape == (0,)
    with pytest.raises(ox.InvalidValueError, match=r"Scene\.meshes\[1\] takes a Mesh"):
        Scene([Mesh(None, Camera(0)), Camera(0)])


def test_copies_are_independent() -> None:
    camera = Camera((1, 2, 3))
    for other in (ox.copy(camera), python_copy.copy(camera)):
        other.fov = 9.0
        assert camera.fov == 1.5
        assert other.eye == camera.eye


def test_a_field_that_no_memory_can_hold() -> None:
    with pytest.raises(TypeError, match=r"Wrong\.name.*not a type that a struct can hold"):

        @ox.struct
        class Wrong:
            name: str


def test_payload_words_refuse_unknown_access() -> None:
    assert ox.payload_word(caller="rw", ch="w").semantics == 3 | 8
    with pytest.raises(TypeError, match="caller, ch, ms"):
        ox.payload_word(raygen="r")
    with pytest.raises(TypeError, match='"rw"'):
        ox.payload_word(ch="x")


def test_defaults_that_are_structs_are_not_shared() -> None:
    @ox.struct
    class Inner:
        value: float = 1.0

    @ox.struct
    class Outer:
        inner: Inner = Inner()

    first, second = Outer(), Outer()
    first.inner.value = 5.0
    assert (first.inner.value, second.inner.value, Outer().inner.value) == (5.0, 1.0, 1.0)


def test_a_bool_field_takes_zero_and_one() -> None:
    @ox.struct
    class Switch:
        on: bool

    assert [Switch(value).on for value in (0, 1, np.uint8(1), False)] == [False, True, True, False]
    with pytest.raises(ox.InvalidValueError, match=r"Switch.on takes a bool, not int 2"):
        Switch(2)


def test_a_struct_as_a_numpy_array() -> None:
    @ox.struct
    class Ball:
        centre: float3
        count: ox.int32

    ball = Ball((1.0, 2.0, 3.0), 4)
    array = np.zeros(2, Ball.dtype)
    array[1] = np.array(ball)
    ball.count = 5
    assert array[1]["count"] == 4
    assert np.stack([ball, ball])["count"].tolist() == [5, 5]
    with pytest.raises(TypeError, match=r"a Ball becomes an array of Ball.dtype only; in `array\[i\] = x` write numpy.array\(x\)"):
        array[0] = ball


def test_what_a_struct_class_refuses_to_be_made_of() -> None:
    @ox.struct
    class Inner:
        value: float

    with pytest.raises(TypeError, match="no class that inherits a struct; give it a field of type Inner"):

        @ox.struct
        class Derived(Inner):
            other: float

    with pytest.raises(TypeError, match=r"numpy's float32 is not a type of shaders; write optixc\.float32"):

        @ox.struct
        class Foreign:
            value: np.float32


def test_vectors_equal_tuples_of_their_components() -> None:
    vector = float3(1.0, 2.0, 3.0)
    assert vector == (1.0, 2.0, 3.0)
    assert vector == (1, 2, 3)
    assert vector != (1.0, 2.0)
    assert hash(vector) == hash((1.0, 2.0, 3.0))
    assert vector != ox.int3(1, 2, 3)
    assert vector.bgr == float3(3.0, 2.0, 1.0)


def test_a_matrix_takes_one_index() -> None:
    matrix: Any = ox.float3x3(np.eye(3))
    assert matrix[1][1] == 1.0
    with pytest.raises(TypeError, match="float3x3 takes one index, a row"):
        matrix[1, 1]
