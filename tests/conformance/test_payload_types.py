"""Area F: payload types, who may read and write their words, and mismatches."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import optixc as ox

HEAD = "import optixc as ox\nfrom optixc import float3, uint32\n\n\n"
GUIDE = ('@ox.payload\nclass Ray:\n    a: uint32 = ox.payload_word(caller="w", ch="r")\n'
         '    b: uint32 = ox.payload_word(caller="r", ch="w")\n'
         "\n\n@ox.program\ndef __closesthit__c(ray: Ray):\n    {}\n")


def create(folder: Path, text: str) -> Any:
    path = folder / "shader.py"
    path.write_text(HEAD + text)
    return ox.DeviceContext().module_create(path)


def test_T057_reads_and_writes_are_checked(tmp_path: Path) -> None:
    create(tmp_path, GUIDE.format("ray.b = ray.a"))
    with pytest.raises(ox.CompileError, match=r"a closesthit program may not write `Ray\.a`"):
        create(tmp_path, GUIDE.format("ray.a = uint32(1)"))


@pytest.mark.parametrize("access", ['caller="r", ch="r"', 'ch="w", ms="w"'])
def test_T058_words_that_nobody_writes_or_reads(tmp_path: Path, access: str) -> None:
    with pytest.raises(ox.CompileError, match="written by somebody and read by somebody"):
        create(tmp_path, f"@ox.payload\nclass Ray:\n    a: uint32 = ox.payload_word({access})\n\n\n@ox.program\n"
               "def __miss__m(ray: Ray):\n    pass\n")


def classes(numbers: range) -> str:
    return "".join(f"@ox.payload\nclass P{n}:\n    w: uint32\n    x{n}: float\n\n\n"
                   f"@ox.program\ndef __miss__m{n}(p: P{n}):\n    p.w = uint32({n})\n\n\n"
                   for n in numbers)


def test_T059_at_most_eight_payload_classes_a_module(tmp_path: Path) -> None:
    assert len(create(tmp_path, classes(range(8)))) == 8
    with pytest.raises(ox.CompileError, match="at most 8 payload classes"):
        create(tmp_path, classes(range(9)))


def test_T061_equal_words_are_the_same_type(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text(HEAD + "@ox.payload\nclass Mine:\n    w: uint32\n\n\n"
                                   "@ox.struct\nclass Params:\n    out: ox.Array[uint32]\n\n\n"
                                   "params = ox.launch_params(Params)\n\n\n@ox.program\ndef __raygen__r():\n    ray = Mine(1)\n"
                                   "    ox.trace(ox.Traversable(0), float3(0.0), float3(1.0), payload=ray)\n    params.out[0] = ray.w\n")
    (tmp_path / "b.py").write_text(HEAD + "@ox.payload\nclass Theirs:\n    word: uint32\n\n\n@ox.program\ndef __miss__m(p: Theirs):\n"
                                   "    p.word = p.word + 41\n")
    context = ox.DeviceContext(validation=True)
    raygen = context.program_group_create(raygen=context.module_create(tmp_path / "a.py")["__raygen__r"])
    miss = context.program_group_create(miss=context.module_create(tmp_path / "b.py")["__miss__m"])

    @ox.struct
    class Params:
        out: ox.Array[ox.uint32]

    out = np.zeros(1, np.uint32)
    for simd in (1, 8, 16):
        pipeline = context.pipeline_create([raygen, miss], simd=simd)
        out[0] = 0
        pipeline.launch(Params(out=out), ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()]), 1)
        assert out[0] == 42


def test_a_payload_that_no_program_takes_is_a_fault_in_validation(tmp_path: Path) -> None:
    text = ("@ox.payload\nclass Two:\n    a: float\n    b: float\n\n\n@ox.payload\nclass One:\n    a: float\n\n\n@ox.program\n"
            "def __raygen__r():\n    ray = Two(0.0, 0.0)\n    one = One(0.0)\n"
            "    ox.trace(ox.Traversable(0), float3(0.0), float3(1.0), miss_sbt_index=0, payload=one)\n"
            "    if ox.get_launch_index().x == 3:\n        ox.trace(ox.Traversable(0), float3(0.0), float3(1.0), payload=ray)\n\n\n"
            "@ox.program\ndef __miss__one(ray: One):\n    ray.a = 1.0\n\n\n@ox.program\ndef __miss__two(ray: Two):\n    ray.a = 1.0\n")
    path = tmp_path / "shader.py"
    path.write_text(HEAD + text)
    for simd in (1, 8, 16):
        context = ox.DeviceContext(validation=True)
        module, create_group = context.module_create(path), context.program_group_create
        raygen, one = create_group(raygen=module["__raygen__r"]), create_group(miss=module["__miss__one"])
        two = create_group(miss=module["__miss__two"])
        pipeline = context.pipeline_create([raygen, one, two], simd=simd)
        table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[one.record()])
        with pytest.raises(ox.ValidationFailureError, match="another payload") as caught:
            pipeline.launch(None, table, 8)
        assert caught.value.fault_code == -33
        assert caught.value.launch_index == (3, 0, 0)
        assert any("__miss__one takes a One" in problem for problem in table.check(pipeline))


def test_functions_with_the_optix_enabled_prefix_are_helpers(tmp_path: Path) -> None:
    create(tmp_path, "def __optix_enabled__index() -> uint32:\n    return ox.get_launch_index().x\n\n\n@ox.program\ndef __raygen__r():\n"
           "    i = __optix_enabled__index()\n")


TWO = ("@ox.payload\nclass A:\n    a: float\n\n\n@ox.payload\nclass B:\n    a: uint32\n\n\n@ox.program\ndef __closesthit__a(p: A):\n"
       "    p.a = 1.0\n\n\n@ox.program\ndef __anyhit__b(p: B):\n    p.a += 1\n\n\n@ox.program\ndef __anyhit__any():\n"
       "    ox.set_payload_types(ox.PayloadTypeID.ID_0 | ox.PayloadTypeID.ID_1)\n    ox.set_payload_0(ox.get_payload_0() + 1)\n\n\n")


def test_T060_a_group_of_one_payload(tmp_path: Path) -> None:
    module = create(tmp_path, TWO)
    context = ox.DeviceContext()
    context.program_group_create(closesthit=module["__closesthit__a"], anyhit=module["__anyhit__any"])
    with pytest.raises(ox.PayloadTypeResolutionFailedError, match="__closesthit__a takes a A payload and __anyhit__b a B") as caught:
        context.program_group_create(closesthit=module["__closesthit__a"], anyhit=module["__anyhit__b"])
    assert caught.value.code == 7501


@pytest.mark.parametrize("payload", ["3", "A", "ray if ox.get_launch_index().x > 3 else ray", "other", "(ray, ray)"])
def test_T062_the_payload_of_a_trace_is_known_to_the_compiler(tmp_path: Path, payload: str) -> None:
    raygen = ("@ox.struct\nclass S:\n    a: float\n\n\n@ox.program\ndef __raygen__r():\n    ray = A(0.0)\n    other = S(0.0)\n"
              "    ox.trace(ox.Traversable(0), float3(0.0), float3(1.0), payload={})\n")
    create(tmp_path, TWO + raygen.format("ray"))
    with pytest.raises(ox.CompileError, match="payload"):
        create(tmp_path, TWO + raygen.format(payload))


def test_T063_payload_types_are_not_conditional(tmp_path: Path) -> None:
    text = "@ox.program\ndef __miss__m():\n    if ox.get_ray_tmin() > 0.5:\n        ox.set_payload_types({})\n"
    with pytest.raises(ox.CompileError, match="must be the first statement"):
        create(tmp_path, text.format("1"))
    with pytest.raises(ox.CompileError, match="takes a constant"):
        create(tmp_path, "@ox.program\ndef __miss__m():\n    ox.set_payload_types(ox.get_payload_0())\n")


@pytest.mark.parametrize("simd", [1, 8, 16])
def test_payload_types_in_a_pipeline(tmp_path: Path, simd: int) -> None:
    text = ("@ox.struct\nclass Params:\n    out: ox.Array[uint32]\n\n\nparams = ox.launch_params(Params)\n\n\n"
            "@ox.program\ndef __raygen__r():\n    (w,) = ox.trace(ox.Traversable(0), float3(0.0), float3(1.0), payload=(uint32(5),))\n"
            "    params.out[ox.get_launch_index().x] = w\n\n\n"
            "@ox.program\ndef __miss__m():\n    ox.set_payload_types(ox.PayloadTypeID.ID_0 | ox.PayloadTypeID.ID_1)\n"
            "    ox.set_payload_0(ox.get_payload_0() + 37)\n")
    module, context = create(tmp_path, text), ox.DeviceContext()
    raygen, miss = context.program_group_create(raygen=module["__raygen__r"]), context.program_group_create(miss=module["__miss__m"])
    pipeline = context.pipeline_create([raygen, miss], simd=simd, options=ox.PipelineCompileOptions(num_payload_values=1))

    @ox.struct
    class Params:
        out: ox.Array[ox.uint32]

    out = np.zeros(20, np.uint32)
    pipeline.launch(Params(out=out), ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()]), 20)
    assert out.tolist() == [42] * 20
