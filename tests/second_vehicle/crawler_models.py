"""A pitching crawler in a process that does not know its sensors and tasks."""

from __future__ import annotations

from typing import ClassVar

from packages import HERE, without_sensors
from pitching_crawler.file_model import CrawlerPlatform
from pitching_crawler.vehicle import PitchingCrawler

from inspect_cli.schema.vehicle import SensorModel

PLATFORMS = HERE / "crawler_campaign" / "platforms"


class WithoutEncoders(CrawlerPlatform):
    """The platform without the sensors of its own package."""

    needed: ClassVar[tuple[type[SensorModel], ...]] = ()


def crawler() -> PitchingCrawler:
    """The vehicle of the campaign."""
    text = without_sensors(PLATFORMS / "pitching_crawler.yaml")
    return PitchingCrawler(WithoutEncoders.model_validate_json(text))
