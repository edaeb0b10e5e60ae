"""Frames to an MP4 file that browsers play: H.264, 4:2:0, its index in front."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import av

CODEC = "libx264"
OPTIONS = {"crf": "23", "preset": "veryfast", "tune": "animation", "threads": "1"}
"""One thread: with several the bytes would depend on the machine's number of cores."""
CONTAINER = {"movflags": "+faststart", "fflags": "+bitexact"}


def encode_film(path: Path, frames: Iterable[Any], size_px: tuple[int, int], fps: int) -> None:
    """Write an MP4 file of RGB images (height, width, 3) uint8; the same images, the same bytes.

    That holds for a width and height that are multiples of 16, the encoder's blocks.
    """
    with av.open(str(path), "w", format="mp4", options=CONTAINER) as container:
        stream: Any = container.add_stream(CODEC, rate=fps, options=OPTIONS)
        stream.width, stream.height = size_px
        stream.pix_fmt = "yuv420p"
        stream.codec_context.thread_count = 1
        for image in frames:
            frame = av.VideoFrame.from_ndarray(image, format="rgb24")
            container.mux(stream.encode(frame))
        container.mux(stream.encode())
