#!/usr/bin/python3
"""Trains the net that tells a cone's colour from LiDAR intensity, on simulated returns only.

Reads what hairpin-render-clusters writes, and writes the weights that the daemon is built with. One thread and fixed
seeds: the same data give the same weights."""
import argparse
import sys

import numpy as np
import torch
from torch import nn

PIXELS = 2 * 32 * 32
CLASSES = ("unknown", "blue", "yellow")
BINS = (0.0, 5.0, 7.5, 10.0, 12.5, 15.0)  # of the paper's table I, m


def load(file):
    """Images (n, 2, 32, 32) in 0..2, labels (n), ranges in m (n), numbers of returns (n)."""
    record = np.dtype([("label", "u1"), ("range", "u1"), ("returns", "u1"), ("image", "u1", (2, 32, 32))])
    data = np.fromfile(file, dtype=record)
    return (torch.from_numpy(data["image"].copy()), torch.from_numpy(data["label"].astype(np.int64)),
            torch.from_numpy(data["range"] * np.float32(0.1)), torch.from_numpy(data["returns"].copy()))


def block(planes_in, planes_out):
    return [nn.Conv2d(planes_in, planes_out, 3, stride=2, padding=1), nn.BatchNorm2d(planes_out), nn.ReLU(),
            nn.Dropout2d(0.05)]


def make_net():
    return nn.Sequential(*block(2, 8), *block(8, 16), *block(16, 16), nn.Flatten(), nn.Dropout(0.2),
                         nn.Linear(256, 32), nn.ReLU(), nn.Linear(32, 3))


def cost(logits, labels, wrong_colour_cost):
    """Cross entropy, plus a price on probability given to the other colour: worse than to `unknown`."""
    price = torch.tensor([[0.0, 1.0, 1.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
    probability = torch.softmax(logits, dim=1)
    wrong = (probability * price[labels]).sum(dim=1)
    return nn.functional.cross_entropy(logits, labels) + wrong_colour_cost * wrong.mean()


def augment(images):
    """Mirrored half of the time; brightness varies, since sensors are calibrated differently."""
    images = images.float() / 128.0
    flip = torch.rand(len(images)) < 0.5
    images[flip] = images[flip].flip(3)
    images[:, 0] *= torch.exp(0.15 * torch.randn(len(images), 1, 1))
    return images


def train(net, data, arguments):
    images, labels = data[0], data[1]
    optimizer = torch.optim.AdamW(net.parameters(), lr=3e-3, weight_decay=1e-3)
    steps = arguments.epochs * (len(images) // arguments.batch)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimizer, 6e-3, total_steps=steps)
    for epoch in range(arguments.epochs):
        net.train()
        order = torch.randperm(len(images))
        total = 0.0
        for first in range(0, len(images) - arguments.batch + 1, arguments.batch):
            chosen = order[first:first + arguments.batch]
            optimizer.zero_grad()
            loss = cost(net(augment(images[chosen])), labels[chosen], arguments.wrong_colour_cost)
            loss.backward()
            optimizer.step()
            schedule.step()
            total += loss.item()
        print(f"epoch {epoch + 1}: cost {total * arguments.batch / len(images):.4f}", file=sys.stderr, flush=True)


def report(net, data):
    """Blue and yellow cones by range: right, unknown, wrong; and what is called a colour but has none."""
    net.eval()
    images, labels, ranges, _ = data
    with torch.no_grad():
        said = net(images.float() / 128.0).argmax(dim=1)
    coloured = labels > 0
    for low, high in zip(BINS, BINS[1:]):
        chosen = coloured & (ranges >= low) & (ranges < high)
        right = (said[chosen] == labels[chosen]).float().mean()
        unknown = (said[chosen] == 0).float().mean()
        print(f"{low:5.1f} to {high:4.1f} m: {int(chosen.sum()):5d} cones, right {right:.3f}, unknown {unknown:.3f}, "
              f"wrong {1 - right - unknown:.3f}", file=sys.stderr)
    print(f"cones of no colour: unknown {(said[~coloured] == 0).float().mean():.3f}", file=sys.stderr)


def folded(net):
    """Weights and biases of each layer, batch normalisation folded into the convolution before it."""
    layers = list(net)
    for i, layer in enumerate(layers):
        if isinstance(layer, nn.Linear):
            yield layer.weight, layer.bias
        if isinstance(layer, nn.Conv2d):
            norm = layers[i + 1]
            scale = norm.weight / torch.sqrt(norm.running_var + norm.eps)
            yield layer.weight * scale[:, None, None, None], (layer.bias - norm.running_mean) * scale + norm.bias


def write(net, file):
    with torch.no_grad():
        values = torch.cat([part.flatten() for layer in folded(net) for part in layer]).tolist()
    with open(file, "w", encoding="ascii") as out:
        out.write("// Written by tools/train/lidar_colour: do not edit.\n")
        for first in range(0, len(values), 8):
            out.write(" ".join(f"{value:.6g}f," if "." in f"{value:.6g}" or "e" in f"{value:.6g}" else f"{value:.6g}.f,"
                               for value in values[first:first + 8]) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--train", required=True, help="rendered cones to learn from")
    parser.add_argument("--validate", required=True, help="others, to measure with")
    parser.add_argument("--out", required=True, help="colour_weights.inc")
    parser.add_argument("--epochs", type=int, default=12)
    parser.add_argument("--batch", type=int, default=128)
    parser.add_argument("--wrong-colour-cost", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    torch.manual_seed(arguments.seed)
    torch.set_num_threads(1)
    torch.use_deterministic_algorithms(True)
    net = make_net()
    train(net, load(arguments.train), arguments)
    report(net, load(arguments.validate))
    write(net, arguments.out)


if __name__ == "__main__":
    main()
