"""Whether a PLY, PCD or STL file holds what its header promises.

Open3D leaves what it cannot read uninitialised and only warns. So the size of a file is compared
with its header before it is read: exactly for point clouds, as a lower bound for faces; and the
points of text files are handed out as lines, to be read by a parser that fails aloud. A text
file that is cut within its very last number cannot be told from a whole one.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path

from inspect_cli.scans.files import refused, truncated

PLY_SIZES = {
    "char": 1, "uchar": 1, "int8": 1, "uint8": 1,
    "short": 2, "ushort": 2, "int16": 2, "uint16": 2,
    "int": 4, "uint": 4, "int32": 4, "uint32": 4, "float": 4, "float32": 4,
    "double": 8, "float64": 8,
}  # fmt: skip
MOST_LZF_GAIN = 88
"""LZF writes up to 264 equal bytes as 3 (liblzf), so no PCD file holds more per byte."""
STL_HEAD, STL_FACET = 84, 50
"""Bytes before the first facet and of each facet of a binary STL."""


@dataclass(frozen=True)
class PlyElement:
    """One ``element`` of a PLY header; a list property counts with its length's bytes alone."""

    name: str
    count: int
    properties: tuple[str, ...]
    least_bytes: int
    has_list: bool


@dataclass(frozen=True)
class PlyFile:
    """The header of a PLY file, and the lines of its body if that is text."""

    elements: tuple[PlyElement, ...]
    lines: list[str] | None

    def count(self, name: str) -> int:
        """How many of an element the header promises."""
        return sum(e.count for e in self.elements if e.name == name)

    def vertex_lines(self) -> list[str] | None:
        """The text lines of the vertices."""
        if self.lines is None:
            return None
        names = [e.name for e in self.elements]
        before = sum(e.count for e in self.elements[: names.index("vertex")])
        return self.lines[before : before + self.count("vertex")]


@dataclass(frozen=True)
class PcdFile:
    """The column of each field of a PCD file, and the lines of its body if that is text."""

    columns: dict[str, int]
    lines: list[str] | None


def whole_ply(path: Path) -> PlyFile:
    """The header of a PLY file that is long enough for it; else GeometryError."""
    data = path.read_bytes()
    head, mark, body = data.partition(b"end_header")
    lines = [line.split() for line in head.decode("ascii", "replace").splitlines()]
    if not mark or not lines or lines[0] != ["ply"]:
        raise refused(path, "this is not a PLY file", "its first line has to read 'ply'")
    try:
        elements = _parsed_ply(lines)
        binary = next(line[1] != "ascii" for line in lines if line[:1] == ["format"])
    except (IndexError, KeyError, ValueError, StopIteration) as error:
        raise refused(path, "the PLY header is damaged", "export it again") from error
    body = body.partition(b"\n")[2]
    promised = ", ".join(f"{e.count} {e.name}" for e in elements)
    if binary:
        least = sum(e.count * e.least_bytes for e in elements)
        if len(body) < least:
            raise truncated(path, f"{promised} in {least} bytes", f"{len(body)} bytes")
        return PlyFile(elements, None)
    count = sum(e.count for e in elements)
    last = elements[-1] if elements else None
    width = len(last.properties) if last and not last.has_list else 1
    return PlyFile(elements, _whole_lines(path, body, count, width, promised))


def _parsed_ply(lines: list[list[str]]) -> tuple[PlyElement, ...]:
    elements: list[PlyElement] = []
    for line in lines:
        if line[:1] == ["element"]:
            elements.append(PlyElement(line[1], int(line[2]), (), 0, False))
        elif line[:1] == ["property"]:
            last = elements[-1]
            is_list = line[1] == "list"
            size = PLY_SIZES[line[2] if is_list else line[1]]
            elements[-1] = PlyElement(
                last.name,
                last.count,
                (*last.properties, line[-1]),
                last.least_bytes + size,
                last.has_list or is_list,
            )
    return tuple(elements)


def whole_pcd(path: Path) -> PcdFile:
    """The header of a PCD file that holds all the points it promises; else GeometryError."""
    data = path.read_bytes()
    fields: dict[str, list[str]] = {}
    start = 0
    while "DATA" not in fields:
        end = data.find(b"\n", start)
        words = data[start:end].decode("ascii", "replace").split()
        if end < 0:
            raise refused(path, "this is not a PCD file, or its header is cut", "export it again")
        if words and not words[0].startswith("#"):
            fields[words[0]] = words[1:]
        start = end + 1
    body = data[start:]
    try:
        names, kind = fields["FIELDS"], fields["DATA"][0]
        count = int(fields["POINTS"][0])
        counts = [int(n) for n in fields.get("COUNT", ["1"] * len(names))]
        row = sum(int(s) * n for s, n in zip(fields["SIZE"], counts, strict=True))
    except (IndexError, KeyError, ValueError) as error:
        raise refused(path, "the PCD header is damaged", "export it again") from error
    if not {"x", "y", "z"} <= set(names):
        raise refused(path, f"no fields x y z among {' '.join(names)}", "export the coordinates")
    columns = {name: sum(counts[:k]) for k, name in enumerate(names)}
    if kind == "ascii":
        lines = _whole_lines(path, body, count, sum(counts), f"{count} points")
        return PcdFile(columns, lines)
    least = count * row
    if kind == "binary_compressed":
        least = 8 + struct.unpack_from("<I", body)[0] if len(body) >= 8 else 8
        if len(body) >= least and count * row > MOST_LZF_GAIN * least:
            raise truncated(path, f"{count} points", f"{least} compressed bytes")
    if len(body) < least:
        raise truncated(path, f"{count} points in {least} bytes", f"{len(body)} bytes")
    return PcdFile(columns, None)


def require_whole_stl(path: Path) -> None:
    """GeometryError unless an STL file holds all its facets; text ends with ``endsolid``."""
    data = path.read_bytes()
    if data.lstrip()[:5].lower() == b"solid" and b"facet" in data[:1000]:
        if b"endsolid" not in data[-1000:].lower():
            raise truncated(path, "a solid", "no endsolid")
        return
    if len(data) < STL_HEAD:
        raise refused(path, "this is not an STL file", "export it again")
    count = struct.unpack_from("<I", data, STL_HEAD - 4)[0]
    found = (len(data) - STL_HEAD) // STL_FACET
    if found < count:
        raise truncated(path, f"{count} facets", str(found))


def _whole_lines(path: Path, body: bytes, count: int, width: int, promised: str) -> list[str]:
    """The body's first ``count`` lines, the last of ``width`` words; else GeometryError."""
    lines = [line for line in body.decode("ascii", "replace").splitlines() if line.strip()]
    if len(lines) < count:
        raise truncated(path, promised, f"{len(lines)} lines")
    if count and len(lines[count - 1].split()) < width:
        raise truncated(path, promised, f"{count - 1} whole lines")
    return lines[:count]
