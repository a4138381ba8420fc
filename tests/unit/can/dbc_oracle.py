#!/usr/bin/python3
"""dbc_oracle.py DBC COUNT SEED: COUNT random frames of each message, as canmatrix packs and unpacks them.

A line each: message, payload in hex, signal=value ... (values as exact decimals). Half of them are packed from random
values, half are unpacked from random bytes.
"""
import logging
import random
import sys

logging.disable(logging.ERROR)
import canmatrix.formats  # noqa: E402


def random_value(rng, signal):
    low, high = (int((limit - signal.offset) / signal.factor) for limit in (signal.min, signal.max))
    raw = rng.choice([low, high, rng.randint(low, high)])
    return raw * signal.factor + signal.offset


def packed(rng, frame):
    values = {signal.name: random_value(rng, signal) for signal in frame.signals}
    return bytes(frame.encode({signal.name: signal.phys2raw(values[signal.name]) for signal in frame.signals})), values


def unpacked(rng, frame):
    data = bytes(rng.randrange(256) for _ in range(frame.size))
    values = {name: decoded.phys_value for name, decoded in frame.decode(data).items()}
    return data, values


def main():
    path, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    rng = random.Random(seed)
    matrix = next(iter(canmatrix.formats.loadp(path).values()))
    for frame in matrix.frames:
        for i in range(count):
            data, values = (packed if i % 2 == 0 else unpacked)(rng, frame)
            fields = " ".join(f"{name}={value}" for name, value in values.items())
            print(frame.name, data.hex(), fields)


if __name__ == "__main__":
    main()
