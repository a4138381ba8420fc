#!/usr/bin/python3
"""dbc_oracle.py DBC COUNT SEED: COUNT random frames of each message, as canmatrix packs and unpacks them.
dbc_oracle.py DBC decode ID=PAYLOAD ...: what it reads in these frames, identifier and payload in hex.

A line each: message, payload in hex, signal=value ... (values as exact decimals). Of the random ones half are packed from
random values, half are unpacked from random bytes.
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


def show(frame, data, values):
    print(frame.name, data.hex(), " ".join(f"{name}={value}" for name, value in values.items()))


def decode(matrix, words):
    for word in words:
        identifier, payload = word.split("=")
        frame = next(frame for frame in matrix.frames if frame.arbitration_id.id == int(identifier, 16))
        data = bytes.fromhex(payload)
        show(frame, data, {name: decoded.phys_value for name, decoded in frame.decode(data).items()})


def main():
    path, *words = sys.argv[1:]
    matrix = next(iter(canmatrix.formats.loadp(path).values()))
    if words[0] == "decode":
        decode(matrix, words[1:])
        return
    count, seed = int(words[0]), int(words[1])
    rng = random.Random(seed)
    for frame in matrix.frames:
        for i in range(count):
            show(frame, *(packed if i % 2 == 0 else unpacked)(rng, frame))


if __name__ == "__main__":
    main()
