"""Fixtures that every room's tests share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from inspect_cli.schema.loading import load_platform
from inspect_cli.schema.vehicle import TiltRotorPlatform

Pitched = Callable[[float], TiltRotorPlatform]
ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="session", autouse=True)
def _cache_of_its_own(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Keeps what is computed away from the user's cache."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("INSPECT_CACHE_DIR", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.fixture(scope="session")
def root() -> Path:
    """The checkout."""
    return ROOT


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Real measurements that lie beside the checkout; tests that need them skip elsewhere."""
    folder = ROOT.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("needs the real measurements in ../shared/data, which are not here")
    return folder


@pytest.fixture(scope="session")
def pitched(root: Path) -> Pitched:
    """The platform with its arm at an angle from −z_B: 90° ahead, 150° is 30° off the zenith."""
    platform = load_platform(root / "platforms" / "tilt_rotor_hexarotor.yaml")
    assert isinstance(platform, TiltRotorPlatform)

    def at(pitch_deg: float) -> TiltRotorPlatform:
        tool = platform.tool.model_copy(update={"pitch_deg": pitch_deg})
        return platform.model_copy(update={"tool": tool})

    return at
