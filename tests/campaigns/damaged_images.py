# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Pictures damaged at random: PNG files of all kinds, PGM and PPM files, with changed bytes, chunks deleted, doubled and swapped, wrong
checksums, heads that claim other sizes and kinds, packed data that are none, files cut short, bytes at random.

Each has to be read, or refused with exit status 1 and one message that names the file or tells of its colours, within 20 seconds and 3 GB of addresses.
"""

import struct
import zlib

from campaign import Campaign
from damaged_meshes import check_file

MARK = b"\x89PNG\r\n\x1a\n"

SCENE = """
set Dimension = 2
set Models = finite elements
subsection Domain
  set Shape           = image
  set Image           = damaged.png
  set Image colors    = a: 0..127 ; b: 128..255
  set Color tolerance = 300
end
"""

# Colour type, bits, samples in a pixel.
KINDS = [(0, 1, 1), (0, 2, 1), (0, 4, 1), (0, 8, 1), (0, 16, 1), (2, 8, 3), (2, 16, 3), (3, 2, 1), (3, 4, 1), (3, 8, 1), (4, 8, 2),
         (6, 8, 4), (6, 16, 4)]

SIZES = [0, 1, 2, 3, 17, 1000, 10000, 65536, 1 << 20, 10**8, (1 << 31) - 1, 1 << 31, (1 << 32) - 1]

# Where the seven pictures of an interlaced one begin, and their steps.
PASSES = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def rows_of(width, height, bits, samples, random):
    """Rows of a picture or of one pass, each with its filter in front."""
    if width == 0 or height == 0:
        return b""
    n = (width * bits * samples + 7) // 8
    return b"".join(bytes([random.randrange(5)]) + random.randbytes(n) for _ in range(height))


def png_chunks(random):
    """The chunks (kind, data) of a sound picture."""
    kind, bits, samples = random.choice(KINDS)
    width, height, interlaced = random.randint(1, 40), random.randint(1, 40), random.randrange(2)
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, interlaced))]
    if kind == 3:
        chunks.append((b"PLTE", random.randbytes(3 * 2**bits)))
        if random.randrange(2):
            chunks.append((b"tRNS", random.randbytes(random.randint(1, 2**bits))))
    if interlaced:
        data = b"".join(rows_of((width - x + dx - 1) // dx, (height - y + dy - 1) // dy, bits, samples, random)
                        for x, y, dx, dy in PASSES)
    else:
        data = rows_of(width, height, bits, samples, random)
    packed = zlib.compress(data)
    half = random.randrange(len(packed))
    return chunks + [(b"IDAT", packed[:half]), (b"IDAT", packed[half:]), (b"IEND", b"")]


def file_of(chunks):
    return MARK + b"".join(chunk(*one) for one in chunks)


def pnm(random):
    """A sound PGM or PPM file, as text or as bytes."""
    kind, width, height = random.choice([2, 3, 5, 6]), random.randint(1, 30), random.randint(1, 30)
    largest = random.choice([1, 3, 255, 65535])
    values = [random.randint(0, largest) for _ in range(width * height * (3 if kind in (3, 6) else 1))]
    head = f"P{kind}\n# a comment\n{width} {height}\n{largest}\n".encode()
    if kind < 4:
        return head + " ".join(map(str, values)).encode()
    return head + b"".join(value.to_bytes(2 if largest > 255 else 1, "big") for value in values)


def changed_bytes(data, random):
    data = bytearray(data)
    for _ in range(random.choice([1, 1, 2, 10, 100])):
        data[random.randrange(len(data))] = random.randrange(256)
    return bytes(data)


def damaged_bytes(random):
    return changed_bytes(file_of(png_chunks(random)), random)


def cut_short(random):
    data = random.choice([pnm, lambda random: file_of(png_chunks(random))])(random)
    place = random.randrange(len(data))
    return random.choice([data[:place], data[place:], data[:place] + data[random.randrange(len(data)):], b""])


def other_head(random):
    """Sizes and kinds that the picture does not have, or that none can have, with a right checksum."""
    chunks = png_chunks(random)
    head = list(struct.unpack(">IIBBBBB", chunks[0][1]))
    for _ in range(random.choice([1, 1, 2])):
        k = random.randrange(7)
        head[k] = random.choice(SIZES) if k < 2 else random.randrange(20)
    return file_of([(b"IHDR", struct.pack(">IIBBBBB", *head))] + chunks[1:])


def wrong_checksum(random):
    pieces = [bytearray(chunk(*one)) for one in png_chunks(random)]
    piece = random.choice(pieces)
    piece[-1 - random.randrange(4)] ^= 1 << random.randrange(8)
    return MARK + b"".join(pieces)


def other_chunks(random):
    chunks = png_chunks(random)
    one, two, kind = random.randrange(len(chunks)), random.randrange(len(chunks)), random.randrange(5)
    if kind == 0:
        del chunks[one]
    elif kind == 1:
        chunks.insert(two, chunks[one])
    elif kind == 2:
        chunks[one], chunks[two] = chunks[two], chunks[one]
    elif kind == 3:
        chunks[one] = (random.choice([b"IDAT", b"PLTE", b"tRNS", b"zTXt", b"iCCP", b"abcd"]), chunks[one][1])
    else:
        chunks[one] = (chunks[one][0], chunks[one][1][:random.randrange(len(chunks[one][1]) + 1)])
    return file_of(chunks)


def other_data(random):
    """Packed data that are none, or too few or far too many."""
    chunks = [one for one in png_chunks(random) if one[0] != b"IDAT"]
    data = random.choice([random.randbytes(100), zlib.compress(random.randbytes(10)), zlib.compress(bytes(10**7)),
                          changed_bytes(zlib.compress(random.randbytes(500)), random)])
    return file_of(chunks[:-1] + [(b"IDAT", data), chunks[-1]])


def damaged_pnm(random):
    data = pnm(random)
    if random.randrange(2):
        return changed_bytes(data, random)
    words = data.split(b"\n", 3)
    words[random.choice([0, 2, 3])] = random.choice([b"P7", b"0 0", b"-1 5", b"100000 100000", b"9999999999 2", b"5", b"# P2", b"4 4\n0", b"x"])
    return b"\n".join(words)


def random_bytes(random):
    return random.choice([b"", MARK, b"P5", b"P2 ", b"GIF89a"]) + random.randbytes(random.choice([0, 1, 10, 1000, 100000]))


DAMAGES = [damaged_bytes, cut_short, other_head, wrong_checksum, other_chunks, other_data, damaged_pnm, random_bytes]


def main():
    campaign = Campaign(__doc__, cases=500)
    for case in campaign:
        damage = DAMAGES[case.number % len(DAMAGES)]
        case.write("damaged.png", damage(case.random))
        check_file(case, damage, SCENE, "damaged.png'", "of the image")
    campaign.finish()


if __name__ == "__main__":
    main()
