#!/usr/bin/python3
"""dbc_to_cpp.py IN.dbc OUT.hpp: a C++ struct with pack and unpack functions for each message of a CAN database.

Messages of at most 8 bytes, little-endian integer signals. Signals named Counter and Checksum together make a message
protected; SampleTime or CommandTime gives it a time. The output is used through common/can/dbc.hpp.
"""
import logging
import re
import sys

logging.disable(logging.ERROR)  # it tells of every format that it cannot read
import canmatrix.formats  # noqa: E402

UNITS = {"": "", "100us": "", "%": "_percent", "m/s2": "_mps2", "rad/s": "_radps", "m/s": "_mps", "rad": "_rad",
         "deg": "_deg", "deg/s": "_degps", "Nm": "_nm", "bar": "_bar", "A": "_a", "V": "_v", "km/h": "_kmph"}


def fail(text):
    sys.exit(f"{sys.argv[1]}: {text}")


def snake(name):
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


def camel(name):
    return "".join(part.capitalize() for part in name.split("_"))


def literal(number):
    return repr(float(number))


class Field:
    def __init__(self, frame, signal):
        where = f"{frame.name}.{signal.name}"
        if not signal.is_little_endian or signal.is_float or signal.multiplex:
            fail(f"{where}: only plain little-endian integers are known here")
        if signal.unit not in UNITS:
            fail(f"{where}: unknown unit {signal.unit!r}")
        self.signal = signal
        self.start = signal.get_startbit()
        self.member = snake(signal.name) + UNITS[signal.unit]
        self.scaled = signal.factor != 1 or signal.offset != 0
        if self.scaled:
            self.type = "double"
        elif signal.size == 1:
            self.type = "bool"
        else:
            size = next(bits for bits in (8, 16, 32, 64) if signal.size <= bits)
            self.type = f"{'int' if signal.is_signed else 'uint'}{size}_t"
        raw_min = -(1 << (signal.size - 1)) if signal.is_signed else 0
        raw_max = (1 << (signal.size - (1 if signal.is_signed else 0))) - 1
        lowest, highest = raw_min * signal.factor + signal.offset, raw_max * signal.factor + signal.offset
        if not lowest <= signal.min <= signal.max <= highest:
            fail(f"{where}: its range does not fit its bits")

    def pack(self):
        name, signal = self.member, self.signal
        raw = f"ToRaw(m.{name}, {literal(signal.factor)}, {literal(signal.offset)})" if self.scaled else f"uint64_t{{m.{name}}}"
        if not self.scaled and signal.is_signed:
            raw = f"static_cast<uint64_t>(int64_t{{m.{name}}})"
        return f"InsertBits({raw}, {self.start}, {signal.size})"

    def unpack(self):
        signal = self.signal
        sign = "Signed" if signal.is_signed else "Unsigned"
        raw = f"Extract{sign}(bits, {self.start}, {signal.size})"
        if not self.scaled:
            return f"m.{self.member} = static_cast<{self.type}>({raw});"
        return f"m.{self.member} = ToPhysical({raw}, {literal(signal.factor)}, {literal(signal.offset)});"


def struct_of(frame):
    if frame.size > 8:
        fail(f"{frame.name}: longer than 8 bytes")
    fields = [Field(frame, signal) for signal in sorted(frame.signals, key=lambda s: s.get_startbit())]
    names = {signal.name for signal in frame.signals}
    if ("Counter" in names) != ("Checksum" in names):
        fail(f"{frame.name}: Counter and Checksum come together")
    if "Checksum" in names and fields[-1].start != 8 * (frame.size - 1):
        fail(f"{frame.name}: the Checksum must be the last byte")
    members = "\n".join(f"  {f.type} {f.member}{{}};" for f in fields)
    pack = " |\n           ".join(f.pack() for f in fields)
    unpack = "\n    ".join(f.unpack() for f in fields)
    visit = "\n    ".join(
        f'visit("{f.signal.name}", m.{f.member}, Range{{{literal(f.signal.min)}, {literal(f.signal.max)}}});' for f in fields)
    return f"""struct {camel(frame.name)} {{
  static constexpr const char* kName = "{frame.name}";
  static constexpr uint32_t kId = {frame.arbitration_id.id:#x};
  static constexpr uint8_t kLength = {frame.size};
  static constexpr int kPeriodMs = {frame.cycle_time};
  static constexpr bool kFromComputer = {"true" if "COMPUTER" in frame.transmitters else "false"};
  static constexpr bool kProtected = {"true" if "Checksum" in names else "false"};
{members}

  static uint64_t ToBits(const {camel(frame.name)}& m) {{
    return {pack};
  }}
  static {camel(frame.name)} FromBits(uint64_t bits) {{
    {camel(frame.name)} m;
    {unpack}
    return m;
  }}
  /// Calls `visit(name, member, Range)` for each signal.
  template <class Message, class Visitor>
  static void VisitSignals(Message& m, Visitor&& visit) {{
    {visit}
  }}
}};
"""


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    matrix = next(iter(canmatrix.formats.loadp(sys.argv[1]).values()))
    frames = sorted(matrix.frames, key=lambda frame: frame.arbitration_id.id)
    visits = "\n".join(f"  visit({camel(frame.name)}{{}});" for frame in frames)
    text = f"""// Generated from {sys.argv[1].rsplit("/", 1)[-1]} by dbc_to_cpp.py.
#pragma once

#include "common/can/signal_bits.hpp"

namespace hairpin::dbc {{

{chr(10).join(struct_of(frame) for frame in frames)}
/// Calls `visit(M{{}})` for each message M, by rising identifier.
template <class Visitor>
void ForEachMessage(Visitor&& visit) {{
{visits}
}}

}}  // namespace hairpin::dbc
"""
    with open(sys.argv[2], "w", encoding="utf-8") as out:
        out.write(text)


if __name__ == "__main__":
    main()
