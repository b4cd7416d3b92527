"""Errors of pairs of pictures by numpy and the published FLIP. Reads a line of JSON for each pair, answers with one."""

import json
import sys

import flip_evaluator
import numpy


def screen(linear, exposure):
    """What a screen that clamps shows: 8-bit sRGB, as values from 0 to 1."""
    light = numpy.clip(linear.astype(numpy.float64) * 2.0**exposure, 0.0, 1.0)
    encoded = numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return (numpy.floor(255.0 * encoded + 0.5) / 255.0).astype(numpy.float32)


def answer(request):
    shape = (request["height"], request["width"], 3)
    r, x = (numpy.fromfile(request[key], "<f4").reshape(shape) for key in ("reference", "picture"))
    exposure = request["exposure"]
    flip, _, _ = flip_evaluator.evaluate(
        screen(r, exposure), screen(x, exposure), "LDR", inputsRGB=True, applyMagma=False, parameters={"ppd": 67.0}
    )
    flip = numpy.asarray(flip, numpy.float64).reshape(shape[0] * shape[1], -1)[:, 0]
    r, x = r.astype(numpy.float64), x.astype(numpy.float64)
    squares = ((x - r) ** 2 / (r**2 + 0.01)).mean(axis=2).ravel()
    luminance = numpy.array([0.2126, 0.7152, 0.0722])
    wanted, found = (r @ luminance).sum(), (x @ luminance).sum()
    worst = int(numpy.ceil(0.01 * squares.size))
    return {
        "relmse": squares.mean(),
        "flip": flip.mean(),
        "flip_p99": numpy.sort(flip)[int(numpy.ceil(0.99 * flip.size)) - 1],
        "bias": (found - wanted) / wanted,
        "difference": numpy.abs(x - r).sum() / r.sum(),
        "worst": numpy.sort(squares)[-worst:].mean(),
    }


for line in sys.stdin:
    print(json.dumps(answer(json.loads(line))), flush=True)
