"""Config files that are made to do harm, each with words of the sentence that refuses it."""

import json

LAUGHS = b"a: &a [x, x, x, x, x, x, x, x, x, x]\n" + b"".join(
    b"%c: &%c [%s]\n" % (name, name, b", ".join([b"*%c" % (name - 1)] * 10))
    for name in b"bcdefghij"
)
MERGES = b"a: &a {x: 1}\n" + b"".join(
    b"%c: &%c {<<: [%s]}\n" % (name, name, b", ".join([b"*%c" % (name - 1)] * 10))
    for name in b"bcdefghij"
)
CHAIN = b"a0: &a0 [1]\n" + b"".join(b"a%d: &a%d [*a%d]\n" % (n, n, n - 1) for n in range(1, 300))
GRID = json.dumps(
    {
        "ridge": {"spacing": [0.1 + n * 1e-4 for n in range(600)],
                  "force": [0.1 + n * 1e-4 for n in range(600)]},
        "pretension": {"spacing": [0.1], "published_force": [0.1]},
        "size": {"published_c_nl_force": [0.1] * 600, "published_c_m_force": [0.1] * 600},
    }
).encode()  # fmt: skip
HOSTILE = {
    # what a parser would choke on, or obey
    "billion laughs": (LAUGHS, ["10000 keys and values", "alias"]),
    "merge keys": (MERGES, ["10000 keys and values", "alias"]),
    "holds itself": (b"a: &a [*a]", ["*a within itself", "line 1"]),
    "deep": (b"a: " + b"[" * 100_000, ["20 groups", "line 1"]),
    "deep json": (b'{"a": ' + b"[" * 50_000 + b"]" * 50_000 + b"}", ["20 groups"]),
    "deep by aliases": (CHAIN, ["20 groups"]),
    "python tag": (b"results: !!python/object/apply:os.system ['true']", ["tag", "python/object"]),
    "python name": (b"results: !!python/name:os.system", ["tag", "python/name", "line 1"]),
    "own tag": (b"scene: !x {seed: 1}", ["tag '!x'"]),
    "template": (b"__use_yte__: true\n__definitions__: ['import os']", ["__use_yte__", "line 1"]),
    "template by an alias": (b"results: &a __use_yte__\n*a : true", ["__use_yte__", "line 1"]),
    "template in escapes": (b'{"\\u005f_use_yte__": true}', ["__use_yte__"]),
    "template merged": (b"<<: {__use_yte__: true}", ["__use_yte__"]),
    "100 MB": (b"a: 1 # " + b"x" * 100_000_000, ["262144 bytes"]),
    "long text": (b"results: " + b"x" * 200_000, ["results", "1000 characters"]),
    "long key": (b"? " + b"x" * 200_000 + b"\n: 1", ["unknown key", "xxx"]),
    "long number": (b"scene: {seed: " + b"1" * 10_000 + b"}", ["no YAML", "digits"]),
    "hexadecimal": (b"scene: {seed: 0x" + b"f" * 200_000 + b"}", ["hexadecimal", "decimals"]),
    "base of 60": (b"scene: {seed: 1" + b":1" * 100_000 + b"}", ["base of 60", "decimals"]),
    "octal": (b"scene: {seed: 010}", ["010", "octal", "decimals"]),
    "NUL": (b"results: a\0b", ["no YAML", "not allowed"]),
    "NUL in escapes": (b'results: "a\\0b"', ["results", "can be printed"]),
    "escape sequences": (b'"\\e[2Jx": 1', ["unknown key", "\\x1b"]),
    "surrogates": (b'{"results": "\\ud800"}', ["results", "can be printed"]),
    "Latin-1": (b"results: caf\xe9", ["no UTF-8", "byte 12"]),
    "UTF-16": ("results: x".encode("utf-16"), ["no UTF-8"]),
    "no such day": (b"results: 2024-99-99", ["no YAML", "month"]),
    "list": (b"[1, 2]", ["holds [1, 2]", "group of keys"]),
    "number for a key": (b"scene: {1: 2}", ["unknown key scene.1", "a word"]),
    "pathvars": (b"pathvars: {results: /etc}", ["unknown key 'pathvars'"]),
    # what asks for too much
    "a hundred thousand points": (
        b"robustness: {seed: [" + b", ".join(b"%d" % n for n in range(100_000)) + b"]}",
        ["262144 bytes"],
    ),
    "thirty thousand points": (
        b"robustness: {seed: [" + b", ".join(b"%d" % n for n in range(30_000)) + b"]}",
        ["10000 keys and values"],
    ),
    "a grid of 360 000 points": (GRID, ["12000 runs", "ridge"]),
    "1e9 elements": (
        b"numerics: {accuracy: null, elements_per_section: 1000000000}",
        ["elements_per_section = 1000000000", "at most"],
    ),
    "large networks": (
        b"robustness: {n: [230, 229, 228, 227]}", ["n = 229", "250000 readouts"],
    ),
    "endless network": (b"topology: {crosshatch: [1000000000]}", ["1000000000", "500"]),
    "endless polygon": (b"topology: {polygon: [1000000000]}", ["1000000000", "16"]),
    "endless recording": (b"scene: {duration: 1.0e+20}", ["duration", "GB"]),
    "endless input": (b"scene: {drive_rate: 1.0e+20}", ["drive_rate", "GB"]),
    "tiny elements": (b"experiment: {element: 1.0e-300}", ["element"]),
    # where it would write
    "whole disk": (b"results: /", ["whole disk"]),
    "wildcards": (b"results: '{run}'", ["results", "'{'"]),
    "recording elsewhere": (b"recordings: [{path: '/etc/{a}'}]", ["recordings.path", "'{'"]),
    "long name": (
        b"recordings: [{path: a.csv, name: " + b"x" * 500 + b"}]", ["recordings", "longer"],
    ),
}  # fmt: skip
