"""The platform file of a stiff crawler: that of a pitching crawler under another kind's name."""

from __future__ import annotations

from typing import Literal

from pitching_crawler.file_model import CrawlerPlatform


class StiffCrawlerPlatform(CrawlerPlatform):
    """The same parts in other numbers."""

    kind: Literal["stiff_crawler"]
