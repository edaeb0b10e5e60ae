"""A killed flight loses at most half a second."""

from __future__ import annotations

import signal
import struct
import subprocess
import sys

import numpy as np
import pytest
from logbook import LENGTHS, RECORDS, attachments

from inspect_cli.log.reader import read_log
from inspect_cli.log.writer import LogWriter
from inspect_cli.records import State

ALLOWED_LOSS_S = 0.5


def fly_for_ever(path, root):
    """The child: logs at 100 Hz as fast as it can, and tells each tick once it has passed."""
    import os
    from pathlib import Path

    log = LogWriter(Path(path), RECORDS, LENGTHS)
    for name, data in attachments(Path(root)).items():
        log.attach(name, "application/json", data)
    records = [record.create(LENGTHS) for record in RECORDS]
    k = 0
    while True:
        for record in records:
            record.array.view("<f8")[:] = k
            record.t_s = k / 100
            log.log(record)
        log.flush_due(k / 100)
        os.write(1, struct.pack("<q", k))
        k += 1


@pytest.mark.parametrize("ticks", [17, 873, 2901])
def test_kill_at_any_moment(tmp_path, root, ticks):
    path = tmp_path / "flight.mcap"
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]);"
        "from test_log_killed import fly_for_ever; fly_for_ever(sys.argv[2], sys.argv[3])"
    )
    command = [sys.executable, "-c", code, str(root / "tests/log"), str(path), str(root)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, cwd=root) as child:
        told = child.stdout.read(8 * ticks)
        child.send_signal(signal.SIGKILL)
        told += child.stdout.read()
    assert child.returncode == -signal.SIGKILL
    passed = struct.unpack_from("<q", told, len(told) - len(told) % 8 - 8)[0]
    assert passed >= ticks - 1
    assert not path.exists()
    log = read_log(tmp_path / "flight.mcap.part")
    assert log.status == "interrupted"
    assert set(log.attachments) == set(attachments(root))
    rows = log.rows(State)
    kept = 0 if rows is None else rows.size
    assert kept >= passed - ALLOWED_LOSS_S * 100
    for record in RECORDS if kept else ():
        found = log.rows(record)
        assert found["t_s"].tolist() == [k / 100 for k in range(kept)]
        numbers = found.view("<f8").reshape(kept, -1)[:, 1:]
        assert (numbers == np.arange(kept)[:, None]).all()
