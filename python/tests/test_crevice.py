# SPDX-License-Identifier: MIT
"""The Python module: values, arrays of every kind, errors, threads, references.

Expected values come from closed forms, from the tool (CREVICE_TOOL) or from the same call
on a plain array.
"""
import gc
import logging
import math
import os
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import crevice

ROWS, COLUMNS = 48, 64


def pit(dtype=np.float32):
    """A floor 5 units away with a pit: something to occlude."""
    y, x = np.mgrid[0:ROWS, 0:COLUMNS]
    depth = np.full((ROWS, COLUMNS), 4.5)
    depth[(x - 32) ** 2 + (y - 24) ** 2 < 100] = 5
    return depth.astype(dtype)


def run(depth, **keywords):
    return crevice.ao(depth, vfov=60, radius=0.9, **keywords)


@pytest.fixture(scope="module")
def plain():
    return run(pit())


def test_a_plane_is_open():
    result = crevice.ao(np.full((ROWS, COLUMNS), 3, np.float32), vfov=50, radius=0.5)
    assert result.shape == (ROWS, COLUMNS) and result.dtype == np.float32
    assert np.abs(result - 1).max() < 1e-3


def test_a_groove_meets_its_closed_form():
    # METHODS: a 90-degree groove seen along its bisector; uniform weighting without falloff
    # occludes (1 - c)/2 at distance c R from the wall. 64 directions and 64 steps leave the
    # sampling error of the outermost step, about 1/64.
    size, scale = 129, 40.0
    x = (np.arange(size) + 0.5 - size / 2) / scale
    depth = np.broadcast_to(5 - np.abs(x), (size, size)).astype(np.float32)
    camera = crevice.Camera(scale, scale, size / 2, size / 2, orthographic=True)
    radius = 1.0
    result = crevice.ao(depth, camera=camera, radius=radius, method="hbao", filter="none",
                        falloff="none", directions=64, steps=64, exact=True)
    for pixel in (70, 76, 84):
        c = abs(x[pixel]) * math.sqrt(2) / radius
        found = 1 - result[40:90, pixel].mean()
        assert found == pytest.approx((1 - c) / 2, abs=0.02)


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64])
def test_float_types(plain, dtype):
    # 4.5 and 5 are exact in half floats.
    assert np.array_equal(run(pit(dtype)), plain)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.int16])
def test_integer_types(dtype):
    depth = (pit() * 2).astype(dtype)
    assert np.array_equal(crevice.ao(depth, vfov=60, radius=1.8),
                          crevice.ao(depth.astype(np.float32), vfov=60, radius=1.8))


def test_strides(plain):
    wide = np.repeat(np.repeat(pit(), 2, axis=0), 3, axis=1)
    assert np.array_equal(run(wide[::2, ::3]), plain)
    flipped = pit()[::-1, ::-1].copy()
    assert np.array_equal(run(flipped[::-1, ::-1]), plain)
    assert np.array_equal(run(np.asfortranarray(pit())), plain)
    assert np.array_equal(run(np.stack([pit(), pit()], axis=2)[:, :, 1]), plain)
    packed = np.zeros(ROWS * COLUMNS, dtype=[("pad", "u1"), ("z", "f4")])
    packed["z"] = pit().ravel()
    assert np.array_equal(run(packed["z"].reshape(ROWS, COLUMNS)), plain)
    assert np.array_equal(run(memoryview(pit())), plain)


def test_inputs_are_not_copied_or_changed(plain):
    depth = pit()
    depth.flags.writeable = False
    out = np.empty_like(plain)
    assert run(depth, out=out) is out
    assert np.array_equal(out, plain)


def test_background():
    depth = pit()
    expected = depth.copy()
    expected[:8] = np.inf
    expected = run(expected)
    assert (expected[:8] == 1).all()
    for hole in (np.nan, 0.0):
        other = depth.copy()
        other[:8] = hole
        assert np.array_equal(run(other), expected)
    other[:8] = -1  # background, too, but no renderer means it
    with pytest.warns(UserWarning, match="outside of what its encoding can hold"):
        assert np.array_equal(run(other), expected)
    mask = np.zeros(depth.shape, bool)
    mask[:8] = True
    assert np.array_equal(run(np.ma.masked_array(depth, mask)), expected)
    far = depth.copy()
    far[:8] = 1e10
    assert np.array_equal(run(far, background=1e9), expected)


def test_normals_and_their_space():
    normals = np.zeros((ROWS, COLUMNS, 3))
    normals[..., 2] = 1
    camera = crevice.Camera.perspective(COLUMNS, ROWS, 60).look_at((0, 0, 0), (1, 0, 0))
    world = np.zeros_like(normals)
    world[..., 0] = -1  # the camera looks along +X, so this faces it
    # Rotating 0 and 1 is exact.
    assert np.array_equal(
        crevice.ao(pit(), normals, camera=camera, radius=0.9),
        crevice.ao(pit(), world, camera=camera, radius=0.9, normal_space="world"))


def test_the_guard_band(plain):
    inner = run(pit(), guard=(1, 2, 3, 4))
    assert inner.shape == (ROWS - 6, COLUMNS - 4)


def test_a_radius_is_chosen_and_told(caplog):
    with caplog.at_level(logging.INFO, logger="crevice"):
        crevice.ao(pit(), vfov=60)
    # 5 % of the view's height, 2 tan(30 degrees) 4.5.
    assert f"{0.05 * 2 * math.tan(math.radians(30)) * 4.5:g}"[:5] in caplog.text


def test_objects_for_many_frames(plain):
    context = crevice.Context(threads=1)
    gbuffer = crevice.GBuffer(context, COLUMNS, ROWS)
    plan = crevice.Plan(gbuffer, options={"radius": "0.9"})
    camera = crevice.Camera.perspective(COLUMNS, ROWS, 60)
    out = np.empty((ROWS, COLUMNS), np.float32)
    for _ in range(2):
        gbuffer.set_camera(camera)
        gbuffer.set_depth(pit())
        plan.run(gbuffer, out)
        assert np.array_equal(out, plain)
    plan.set_options({"radius": "0.5"})
    assert not np.array_equal(plan.run(gbuffer, out), plain)
    depth = np.empty_like(out)
    gbuffer.get_depth(depth)
    assert np.array_equal(depth, pit())
    normals = np.empty((ROWS, COLUMNS, 3), np.float32)
    gbuffer.get_normals(normals)
    assert np.allclose(np.linalg.norm(normals, axis=2), 1, atol=1e-5)


def test_the_registry():
    names = [method.name for method in crevice.methods()]
    assert "hbao" in names and "alchemy" in names
    assert "bilateral13" in [item.name for item in crevice.filters()]
    for name in names:
        rows = {option.key: option for option in crevice.options(name)}
        assert rows["radius"].unit == "scene units"
        for option in rows.values():
            assert option.help and option.min <= option.default <= option.max
        run(pit(), method=name)


def test_bent_normals(plain):
    # A plane that is tilted by 45 degrees, seen by a parallel camera: its bent normal is its
    # normal, (0, 1, 1)/sqrt(2) in view space.
    rows = (np.arange(ROWS) + 0.5 - ROWS / 2) / 20
    depth = np.broadcast_to((5 - rows)[:, None], (ROWS, COLUMNS)).astype(np.float32)
    camera = crevice.Camera(20, 20, COLUMNS / 2, ROWS / 2, orthographic=True)
    for method in crevice.methods():
        if not method.bent_normal:
            continue
        result, bent = crevice.ao(depth, camera=camera, radius=0.5, method=method.name,
                                  return_bent_normal=True)
        assert bent.shape == (ROWS, COLUMNS, 3) and bent.dtype == np.float32
        assert np.allclose(bent, [0, math.sqrt(0.5), math.sqrt(0.5)], atol=1e-3)
        assert np.array_equal(result, crevice.ao(depth, camera=camera, radius=0.5,
                                                 method=method.name))
    # Left of the pit's centre the wall is on the left: open directions lie on the right.
    result, bent = run(pit(), method="gtao", return_bent_normal=True)
    assert (bent[22:26, 24, 0] > 0.05).all() and (bent[22:26, 39, 0] < -0.05).all()
    assert np.allclose(np.linalg.norm(bent, axis=2), 1, atol=1e-5)
    with pytest.raises(crevice.InvalidArgument, match="gives no bent normals"):
        with pytest.warns(UserWarning, match="bent_normal"):
            run(pit(), method="alchemy", return_bent_normal=True)
    _, inner = run(pit(), method="gtao", guard=(1, 2, 3, 4), return_bent_normal=True)
    assert inner.shape == (ROWS - 6, COLUMNS - 4, 3)


def test_plans_give_bent_normals():
    context = crevice.Context(threads=1)
    gbuffer = crevice.GBuffer(context, COLUMNS, ROWS)
    gbuffer.set_camera(crevice.Camera.perspective(COLUMNS, ROWS, 60))
    gbuffer.set_depth(pit())
    out = np.empty((ROWS, COLUMNS), np.float32)
    bent = np.empty((ROWS, COLUMNS, 3), np.float32)
    plan = crevice.Plan(gbuffer, method="gtao", options={"radius": "0.9", "bent_normal": "on"})
    first, second = plan.run(gbuffer, out, bent=bent)
    assert first is out and second is bent
    expected = run(pit(), method="gtao", return_bent_normal=True)
    assert np.array_equal(out, expected[0]) and np.array_equal(bent, expected[1])
    assert plan.run(gbuffer, out) is out
    with pytest.raises(TypeError, match="float32"):
        plan.run(gbuffer, out, bent=np.empty((ROWS, COLUMNS, 3)))
    without = crevice.Plan(gbuffer, method="gtao", options={"radius": "0.9"})
    with pytest.raises(crevice.InvalidArgument, match="bent_normal to 1"):
        without.run(gbuffer, out, bent)


@pytest.mark.parametrize("keywords, kind, words", [
    ({"method": "nothing"}, ValueError, "nothing"),
    ({"preset": "huge"}, ValueError, "huge"),
    ({"filter": "blur"}, crevice.Error, "blur"),
    ({"steps": 0}, crevice.InvalidArgument, "steps"),
    ({"stepz": 4}, crevice.InvalidArgument, "stepz"),
    ({"encoding": "log2"}, ValueError, "log2"),
    ({"encoding": "hardware"}, crevice.InvalidArgument, "near"),
    ({"guard": 40}, crevice.InvalidArgument, "guard"),
    ({"out": np.empty((2, 2), np.float32)}, crevice.InvalidArgument, "result"),
    ({"out": np.empty((ROWS, COLUMNS))}, TypeError, "float32"),
    ({"normals": np.zeros((ROWS, COLUMNS))}, ValueError, "normals"),
    ({"normals": np.zeros((3, 3, 3))}, crevice.InvalidArgument, "normals"),
    ({"camera": crevice.Camera(0, 1, 0, 0)}, TypeError, "either"),
])
def test_errors(keywords, kind, words):
    with pytest.raises(kind, match=words):
        run(pit(), **keywords)


def test_bad_arrays():
    for bad in (np.zeros((4, 4), complex), np.zeros((4, 4), ">f4"), np.zeros((4, 4), object)):
        with pytest.raises((TypeError, ValueError)):
            run(bad)
    for bad in (np.zeros(4), np.zeros((2, 2, 2)), np.zeros((0, 4)), 3.0):
        with pytest.raises((crevice.Error, TypeError, ValueError)):
            run(bad)
    with pytest.raises(crevice.NotReady):
        gbuffer = crevice.GBuffer(crevice.Context(), 4, 4)
        gbuffer.set_depth(np.zeros((4, 4)))


def test_warnings():
    with pytest.warns(UserWarning, match="samples"):
        run(pit(), method="hbao", samples=99)


def test_threads(plain):
    results = []

    def work(context):
        gbuffer = crevice.GBuffer(context, COLUMNS, ROWS)
        plan = crevice.Plan(gbuffer, options={"radius": "0.9"})
        for _ in range(20):
            gbuffer.set_camera(crevice.Camera.perspective(COLUMNS, ROWS, 60))
            gbuffer.set_depth(pit())
            results.append(plan.run(gbuffer, np.empty((ROWS, COLUMNS), np.float32)))

    shared = crevice.Context(threads=1)
    contexts = [shared, shared, crevice.Context(threads=1), crevice.Context(threads=1)]
    workers = [threading.Thread(target=work, args=(context,)) for context in contexts]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert len(results) == 80
    assert all(np.array_equal(result, plain) for result in results)


def test_what_is_likely_meant():
    with pytest.warns(UserWarning, match="1.05 radians are 60.16 degrees"):
        crevice.ao(pit(), vfov=1.05, radius=0.9)
    with pytest.raises(crevice.InvalidArgument, match="did you mean 'hbao'"):
        run(pit(), method="hboa")
    with pytest.raises(crevice.InvalidArgument, match="vo gives no bent normals; choose one of .*gtao"):
        run(pit(), method="vo", return_bent_normal=True)


class Interrupt(Exception):
    """What the handler of the test's signal raises, as Ctrl-C raises KeyboardInterrupt."""


def test_a_signal_ends_a_run():
    def handler(number, frame):
        raise Interrupt

    depth = np.tile(pit(), (8, 8))
    context = crevice.Context(threads=1)
    gbuffer = crevice.GBuffer(context, 8 * COLUMNS, 8 * ROWS)
    gbuffer.set_camera(crevice.Camera.perspective(8 * COLUMNS, 8 * ROWS, 60))
    gbuffer.set_depth(depth)
    # 1.6e9 steps, some ten seconds; it looks for signals after each tile of 3e7 steps.
    long = crevice.Plan(gbuffer, method="raymarch",
                        options={"radius": "0.9", "directions": "16", "normal_rays": "8",
                                 "steps": "64", "filter": "none"})
    out = np.zeros(depth.shape, np.float32)
    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(Interrupt):
            long.run(gbuffer, out)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert not out.any()
    usual = crevice.Plan(gbuffer, options={"radius": "0.9"})
    expected = crevice.ao(depth, vfov=60, radius=0.9)
    assert np.array_equal(usual.run(gbuffer, out), expected)


def test_no_references_are_lost():
    depth, out = pit(), np.empty((ROWS, COLUMNS), np.float32)
    tiny = np.full((4, 4), 2, np.float32)
    before = (sys.getrefcount(depth), sys.getrefcount(out), sys.getrefcount(tiny))
    run(depth, out=out)
    with open("/proc/self/statm", encoding="ascii") as statm:
        gc.collect()
        for _ in range(200):
            crevice.ao(tiny, vfov=60, radius=1, threads=1, method="hbao")
        start = int(statm.read().split()[1])
    for _ in range(10000):
        crevice.ao(tiny, vfov=60, radius=1, threads=1, method="hbao")
    with pytest.raises(ValueError):
        run(depth, method="nothing")
    with open("/proc/self/statm", encoding="ascii") as statm:
        grown = int(statm.read().split()[1]) - start
    assert (sys.getrefcount(depth), sys.getrefcount(out), sys.getrefcount(tiny)) == before
    # 10,000 leaks of even 64 bytes were 160 pages of 4 KiB; allocators keep a few.
    assert grown < 100


@pytest.mark.skipif("CREVICE_TOOL" not in os.environ, reason="CREVICE_TOOL is not set")
def test_same_bits_as_the_tool(tmp_path, plain):
    path = tmp_path / "depth.pfm"
    with open(path, "wb") as file:
        file.write(f"Pf\n{COLUMNS} {ROWS}\n-1\n".encode())
        file.write(np.flipud(pit()).astype("<f4").tobytes())
    subprocess.run([os.environ["CREVICE_TOOL"], "ao", path, "-o", tmp_path / "ao.pfm",
                    "--vfov", "60", "--radius", "0.9", "-q"], check=True)
    data = (tmp_path / "ao.pfm").read_bytes()
    pixels = np.frombuffer(data[-ROWS * COLUMNS * 4:], "<f4").reshape(ROWS, COLUMNS)
    assert np.array_equal(np.flipud(pixels), plain)
