"""A chapter that inspect does not have: what the wrench sensor at a contact measured."""

from __future__ import annotations

import numpy as np

from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.content.blocks import Block, Paragraph
from pitching_crawler.sensors import ContactForce


def _blocks(material: Material) -> list[Block]:
    force = np.linalg.norm(material.log.rows(ContactForce)["f_B"], axis=1)
    return [Paragraph(f"The wrench sensor measured up to {force.max():.1f} N.")]


CHAPTER = Chapter(
    heading="Wrench on a contact",
    applies=lambda material: material.log.rows(ContactForce) is not None,
    blocks=_blocks,
)
