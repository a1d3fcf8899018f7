# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Files that are none: devices, pipes, folders, far too large or deeply nested ones in place of scenes, studies, meshes and pictures.

Each is refused within seconds and 3 GB of addresses, with exit status 1 and one message.
"""

import functools
import os
import resource
import struct
import subprocess
import zlib

from scene_test import EXECUTABLE, Run, check, check_clean_error, check_message, finish, print_table, temporary_folder, write_file

FOLDER = temporary_folder()
write = functools.partial(write_file, folder=FOLDER)

MESH = "set Models = finite elements\nsubsection Domain\nset Shape = mesh file\nset Mesh file = {}\nend\nsubsection Peridynamics\nset Horizon = 1\nend\n"

IMAGE = ("set Models = finite elements\nsubsection Domain\nset Shape = image\nset Image = {}\nset Image colors = a: 0..255\n"
         "set Cells per pixel = {}\nend\n")


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def grey_png(width, height):
    """A picture of zeros whose head says that it is so large, and that has the data of 3 x 3 pixels, or all of them."""
    rows = bytes(12) if width * height > 10**6 else bytes((width + 1) * height)
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)), (b"IDAT", zlib.compress(rows)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks)


def main():
    pipe = os.path.join(FOLDER, "pipe")
    os.mkfifo(pipe)
    large = os.path.join(FOLDER, "large.prm")
    with open(large, "wb") as file:
        file.truncate(17_000_000)
    deep = "".join(f"subsection s{k}\n" for k in range(30000)) + "end\n" * 30000
    study = write("deep.json", '{"rows": ' + "[" * 200000 + "]" * 200000 + "}")
    cases = [("zeros without end", ["/dev/zero"], ["'/dev/zero'", "device"]),
             ("nothing", ["/dev/null"], ["'/dev/null'", "device"]),
             ("a pipe", [pipe], ["pipe'", "cannot be read"]),
             ("a folder", [FOLDER], ["cannot be read", "directory"]),
             ("a scene of 17 MB", [large], ["large.prm", "16 MB"]),
             ("30000 sections in each other", [write("deep.prm", deep)], ["deep.prm:17", "subsection"]),
             ("a line of 10 MB", [write("line.prm", "x" * 10**7)], ["line.prm:1", "is none of"]),
             ("a name of 10 MB", [write("name.prm", "set " + "x" * 10**7 + " = 1\n")], ["name.prm:1", "unknown entry"]),
             ("parentheses without end", [write("formula.prm", "subsection Material\nset Conductivity = " + "(" * 10**6 + "\nend\n")],
              ["'Conductivity'"]),
             ("a mesh of zeros", [write("mesh.prm", MESH.format("/dev/zero"))], ["'Mesh file'", "device"]),
             ("a mesh that is a pipe", [write("mesh2.prm", MESH.format(pipe))], ["'Mesh file'", "pipe"]),
             ("a mesh that is a folder", [write("mesh3.prm", MESH.format(FOLDER))], ["'Mesh file'", "directory"]),
             ("a picture of zeros", [write("image.prm", IMAGE.format("/dev/zero", 1))], ["'Image'", "device"]),
             ("a picture that claims 1e8 pixels", [write("image2.prm", IMAGE.format(write("claim.png", grey_png(10000, 10000)), 1))],
              ["'Image'", "claim.png", "cut short"]),
             ("a picture of 1e12 cells", [write("image3.prm", IMAGE.format(write("grey.png", grey_png(1000, 1000)), 1000))],
              ["'Cells per pixel'", "1e+12", "memory"])]
    rows = []
    for what, arguments, words in cases:
        rows.append((what, ask("check", arguments, words)))
    os.symlink("/dev/zero", os.path.join(FOLDER, "zeros.json"))
    for what, path, words in (("a study of zeros", "zeros.json", ["'zeros.json'", "device"]),
                              ("200000 brackets in each other", study, ["deep.json", "brackets"])):
        rows.append((what, ask("study", [path], words)))
    print_table("Refused", ("what", "message"), rows)


def ask(command, arguments, words):
    """Run the program; its message."""
    try:
        done = subprocess.run([EXECUTABLE, command, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60,
                              errors="replace", cwd=FOLDER, preexec_fn=limit_memory)
    except subprocess.TimeoutExpired:
        check(False, f"{command} {arguments} did not end")
        return ""
    run = Run(FOLDER, done.returncode, done.stdout, done.stderr)
    check_clean_error(run, f"{command} {arguments}")
    check_message(run, *words)
    check(len(done.stderr) < 5000, f"{arguments}: a message of {len(done.stderr)} characters")
    return done.stderr.strip()[-120:]


if __name__ == "__main__":
    main()
    finish()
