# SPDX-License-Identifier: BSD-3-Clause
"""Ordinary picture files byte by byte, from the published layouts alone: no reader or writer of anybody's."""

import struct
import zlib


def png(columns, rows, channels, bits, samples):
    """A PNG (ISO/IEC 15948) of `samples`, row by row, filter 0; says nothing about its colours."""
    def chunk(name, payload):
        return struct.pack(">I", len(payload)) + name + payload + struct.pack(">I", zlib.crc32(name + payload))

    header = struct.pack(">2I5B", columns, rows, bits, {1: 0, 2: 4, 3: 2, 4: 6}[channels], 0, 0, 0)
    size = columns * channels
    lines = b"".join(b"\0" + struct.pack(f">{size}{'B' if bits == 8 else 'H'}", *samples[row * size:(row + 1) * size])
                     for row in range(rows))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))


def read_png(path):
    """Rows of pixels, tuples of samples, of a PNG of 8 bits without interlacing."""
    data, at, compressed = path.read_bytes(), 8, b""
    columns, rows, bits, colour = struct.unpack(">2I2B", data[16:26])
    assert bits == 8, bits
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        compressed += data[at + 8:at + 8 + size] if name == b"IDAT" else b""
        at += size + 12
    lines, step = zlib.decompress(compressed), {0: 1, 4: 2, 2: 3, 6: 4}[colour]
    width, above, picture = columns * step, bytes(columns * step), []
    for row in range(rows):
        kind, line = lines[row * (width + 1)], bytearray(lines[row * (width + 1) + 1:(row + 1) * (width + 1)])
        for i in range(width):
            left, up, corner = (line[i - step] if i >= step else 0), above[i], (above[i - step] if i >= step else 0)
            nearest = min((left, up, corner), key=lambda value: abs(left + up - corner - value))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, nearest)[kind]) % 256
        above = bytes(line)
        picture.append([tuple(above[i:i + step]) for i in range(0, width, step)])
    return picture


def tiff(columns, rows, channels, bits, samples, order="<"):
    """A baseline TIFF 6.0 of one strip, little- ("<") or big-endian (">")."""
    pixels = struct.pack(f"{order}{len(samples)}{'B' if bits == 8 else 'H'}", *samples)
    entries = [(256, 4, columns), (257, 4, rows), (258, 3, bits), (259, 3, 1), (262, 3, 2 if channels == 3 else 1),
               (273, 4, 8), (277, 3, channels), (278, 4, rows), (279, 4, len(pixels))]
    tail = b""
    directory_at = 8 + len(pixels) + len(pixels) % 2
    if channels > 1:  # three bit depths do not fit into the entry
        tail = struct.pack(f"{order}{channels}H", *[bits] * channels)
        entries[2] = (258, 3, None)
    directory = struct.pack(order + "H", len(entries))
    for tag, kind, value in entries:
        if value is None:
            field = struct.pack(order + "I", directory_at + 2 + 12 * len(entries) + 4)
            directory += struct.pack(order + "HHI", tag, kind, channels) + field
        else:
            field = struct.pack(order + "H2x", value) if kind == 3 else struct.pack(order + "I", value)
            directory += struct.pack(order + "HHI", tag, kind, 1) + field
    directory += struct.pack(order + "I", 0) + tail
    mark = b"II" if order == "<" else b"MM"
    return mark + struct.pack(order + "HI", 42, directory_at) + pixels + b"\0" * (len(pixels) % 2) + directory


def grey_jpeg(levels):
    """A baseline JPEG (ITU-T T.81) of flat blocks of 8 x 8 side by side: quantisation by 1, so that each block is one
    coefficient, 8 (level - 128). Codes: category n of a difference is n in four bits, the end of a block one zero."""
    def segment(marker, payload):
        return struct.pack(">2BH", 0xFF, marker, len(payload) + 2) + payload

    categories = bytes(range(12))  # all of four bits: the codes count up
    dc = b"\x00" + bytes([0, 0, 0, 12] + [0] * 12) + categories
    ac = b"\x10" + bytes([1] + [0] * 15) + b"\x00"
    bits, last = "", 0
    for level in levels:
        difference, last = 8 * (level - 128) - last, 8 * (level - 128)
        size = abs(difference).bit_length()
        value = difference if difference >= 0 else difference + (1 << size) - 1
        bits += f"{size:04b}" + (f"{value:0{size}b}" if size else "") + "0"
    bits += "1" * (-len(bits) % 8)
    scan = bytes(int(bits[i:i + 8], 2) for i in range(0, len(bits), 8)).replace(b"\xff", b"\xff\0")
    return (b"\xff\xd8" + segment(0xDB, b"\0" + b"\x01" * 64)
            + segment(0xC0, struct.pack(">BHHB3B", 8, 8, 8 * len(levels), 1, 1, 0x11, 0))
            + segment(0xC4, dc) + segment(0xC4, ac) + segment(0xDA, bytes([1, 1, 0, 0, 63, 0])) + scan + b"\xff\xd9")
