"""Renders scenes with Mitsuba 3 on behalf of a test.

Each line of the input is a request in JSON, each line of the output an answer:
    {"load": "DIR/scene.xml", "variant": "scalar_rgb"}    reads a scene, which is rendered from then on
    {"render": SAMPLES, "seed": SEED, "out": FILE}        writes width * height * 3 floats, rows from the top
    {"emitter": FILE, "out": FILE}                        radiance of the environment from directions (floats x, y, z)
Seconds in an answer are those of the rendering alone, with the picture in memory at their end.
"""

import json
import os
import sys
import time

# Mitsuba may print; the answers go where the output went at the start.
answers = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)

import mitsuba as mi
import numpy as np


def load(request):
    mi.set_variant(request["variant"])
    mi.set_log_level(mi.LogLevel.Error)
    return mi.load_file(request["load"])


def render(scene, request):
    start = time.perf_counter()
    picture = np.array(mi.render(scene, spp=request["render"], seed=request["seed"]))
    seconds = time.perf_counter() - start
    picture[:, :, :3].astype("<f4").tofile(request["out"])
    return {"seconds": seconds}


def environment(scene, request):
    emitter = scene.environment()
    found = []
    for x, y, z in np.fromfile(request["emitter"], dtype="<f4").reshape(-1, 3):
        point = mi.SurfaceInteraction3f()
        # An interaction on an emitter at infinity looks back to where the ray came from.
        point.wi = mi.Vector3f(-float(x), -float(y), -float(z))
        found.append(list(emitter.eval(point)))
    np.array(found, dtype="<f4").tofile(request["out"])
    return {}


def main():
    scene = None
    for line in sys.stdin:
        request = json.loads(line)
        try:
            if "load" in request:
                scene = load(request)
                answer = {"version": mi.__version__}
            elif "render" in request:
                answer = render(scene, request)
            else:
                answer = environment(scene, request)
        except Exception as error:
            answer = {"error": str(error)}
        print(json.dumps(answer), file=answers, flush=True)


main()
