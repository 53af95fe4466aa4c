"""Sweeps on clusters: a real scheduler and real workers on the loopback address, and their ends."""

from __future__ import annotations

import contextlib
import os
import random
import signal
import socket
import ssl
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rarely import few

from puck_tables import Normal, Puck, Table
from puck_tables.errors import ClusterError, InputError

pytest.importorskip("zarr")
distributed = pytest.importorskip("distributed")
dask = pytest.importorskip("dask")
client_of = pytest.importorskip("puck_tables.bulk.cluster").client_of
pytestmark = [
    pytest.mark.skipif(os.name == "nt", reason="signals of another kind"),
    pytest.mark.filterwarnings("ignore"),  # of what the libraries of clusters use
]

PUCK = Puck.similar()
QUICK: dict[str, Any] = {"spin": np.linspace(-3.0, 3.0, 301), "speed": np.linspace(0.0, 2.0, 200)}
# integrated, so that there is something to end in the middle of
SLOW: dict[str, Any] = {
    "spin": np.linspace(-3.0, 3.0, 160), "speed": np.linspace(0.0, 2.0, 160), "tol": 1e-9,
    "method": "adaptive",
}  # fmt: skip
DASK = [sys.executable, "-m", "distributed.cli.dask_scheduler"]
WORKER = [sys.executable, "-m", "distributed.cli.dask_worker"]


def content(store: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(store)): path.read_bytes()
        for path in store.rglob("*") if path.is_file() and not path.name.endswith(".partial")
    }  # fmt: skip


def waited_for(found: Callable[[], Any], seconds: float = 90.0) -> Any:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if value := found():
            return value
        time.sleep(0.02)
    raise TimeoutError


@contextmanager
def cluster(
    folder: Path, workers: int, options: Sequence[str] = ()
) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """The address of a scheduler, and the processes: its own, those of its workers."""
    file, quiet = folder / "scheduler.json", {"stderr": subprocess.DEVNULL}
    file.unlink(missing_ok=True)  # of one before
    common = ["--scheduler-file", str(file), "--no-dashboard", *options]
    processes = [subprocess.Popen(
        [*DASK, *common, "--host", "127.0.0.1", "--port", "0"], **quiet, cwd=folder)]  # fmt: skip
    try:
        waited_for(lambda: file.exists() and file.stat().st_size > 0)
        for _ in range(workers):
            alone = ["--no-nanny", "--nthreads", "1", "--host", "127.0.0.1"]
            processes.append(subprocess.Popen([*WORKER, *common, *alone], **quiet, cwd=folder))
        with distributed.Client(scheduler_file=str(file), set_as_default=False) as client:
            address = client.scheduler.address
            if workers:
                client.wait_for_workers(workers, timeout=90)
        yield address, processes
    finally:
        for process in processes:
            process.kill()
            process.wait()


def blocks(store: Path) -> int:
    return len(list((store / "status" / "c").rglob("*"))) if store.exists() else 0


@pytest.mark.thorough
def test_two_workers_write_the_bytes_of_one_thread(tmp_path: Path):
    samples = {"spin": Normal(5.0, 0.2), "speed": 1.0}
    alone = PUCK.sweep(**QUICK, store=tmp_path / "alone.zarr", threads=1)
    drawn = PUCK.sample(50_000, 7, **samples, store=tmp_path / "drawn.zarr", threads=1)
    seen: list[int] = []
    with cluster(tmp_path, 2) as (address, _):
        both = PUCK.sweep(
            **QUICK, store=tmp_path / "both.zarr", cluster=address,
            progress=lambda done, total: seen.append(done),
        )  # fmt: skip
        again = PUCK.sample(50_000, 7, **samples, store=tmp_path / "d2.zarr", cluster=address)
        with pytest.raises(InputError, match="holds other work"):
            PUCK.sweep(spin=[1.0], speed=[2.0], store=tmp_path / "both.zarr", cluster=address)
    assert content(both.path) == content(alone.path)
    assert content(again.path) == content(drawn.path)
    assert both.tally == alone.tally
    assert seen == sorted(seen) and seen[-1] == 301 * 200


@pytest.mark.nightly
def test_a_worker_killed_in_the_middle_costs_nothing(tmp_path: Path):
    work = {**SLOW, "table": Table.shipped()}
    alone = PUCK.sweep(**work, store=tmp_path / "alone.zarr")
    with cluster(tmp_path, 2) as (address, workers):
        store = tmp_path / "both.zarr"

        def kill(done: int, total: int) -> None:
            if total // 8 < done and workers[1].poll() is None:
                workers[1].kill()

        both = PUCK.sweep(**work, store=store, cluster=address, progress=kill)
        assert workers[1].poll() is not None
    assert content(both.path) == content(alone.path)
    assert both.tally == alone.tally


@pytest.mark.nightly
def test_a_client_killed_in_the_middle_goes_on(tmp_path: Path):
    alone = PUCK.sweep(**SLOW, store=tmp_path / "alone.zarr")
    with cluster(tmp_path, 2) as (address, _):
        code = (
            f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r}); "
            "from test_cluster import PUCK, SLOW; "
            f"PUCK.sweep(**SLOW, store='both.zarr', cluster={address!r})"
        )
        store = tmp_path / "both.zarr"
        client = subprocess.Popen([sys.executable, "-c", code], cwd=tmp_path)
        waited_for(lambda: blocks(store) > 10 or client.poll() is not None)
        client.kill()
        client.wait()
        part = blocks(store)
        PUCK.sweep(**SLOW, store=store, cluster=address)
    assert part > 0
    assert content(store) == content(alone.path)


@pytest.mark.nightly
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_leaves_a_cluster_of_its_own_within_a_second_and_goes_on(number, tmp_path):
    code = "from puck_tables.cli.start import main; main()"
    words = ["sweep", "--w0", "0:5:2000", "--speed", "0:2:2000", "--method", "adaptive", "-o",
             "m.zarr", "--cluster", "local:2"]  # fmt: skip
    client = subprocess.Popen(
        [sys.executable, "-c", "import signal; signal.signal(signal.SIGINT, "
         f"signal.default_int_handler); {code}", *words],
        cwd=tmp_path, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    waited_for(lambda: blocks(tmp_path / "m.zarr") > 3)
    begin = time.monotonic()
    os.killpg(client.pid, number)
    error = client.communicate(timeout=60)[1]
    took = time.monotonic() - begin
    assert client.returncode == 128 + number, error
    words = "Interrupted: m.zarr keeps what is done; the same command goes on."
    assert error.splitlines()[-1] == words
    assert "Traceback" not in error
    assert took < 10.0  # a second on a quiet machine; what hangs takes for ever
    # no worker lives on
    waited_for(lambda: subprocess.run(["pgrep", "-g", str(client.pid)]).returncode != 0, 20.0)


def test_what_is_no_cluster_is_refused_and_nothing_is_begun(tmp_path, monkeypatch):
    monkeypatch.setattr("puck_tables.bulk.cluster._REACH", 0.5)  # s
    for where in ("local:0", "local:99999", "here", "tcp://nowhere", "http://127.0.0.1:9", 4):
        with pytest.raises(InputError, match="must be local:N"):
            PUCK.sweep([1.0], 1.0, store=tmp_path / "m.zarr", cluster=where)
    with pytest.raises(ClusterError, match="no scheduler answers at"):
        PUCK.sweep([1.0], 1.0, store=tmp_path / "m.zarr", cluster="tcp://127.0.0.1:9")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.nightly
def test_a_scheduler_without_workers_and_one_that_is_lost(tmp_path: Path):
    with cluster(tmp_path, 0) as (address, _), pytest.raises(ClusterError, match="has no workers"):
        PUCK.sweep([1.0], 1.0, store=tmp_path / "m.zarr", cluster=address)
    with cluster(tmp_path, 1) as (address, workers):

        def kill(done: int, total: int) -> None:
            workers[1].kill()

        with pytest.raises(ClusterError, match=r"no workers any more|was lost"):
            PUCK.sweep(**SLOW, store=tmp_path / "n.zarr", cluster=address, progress=kill)


@contextmanager
def certificates(folder: Path) -> Iterator[list[str]]:
    """Of a cluster, as Dask's configuration has them meanwhile; options of its processes."""
    made = distributed.security.Security.temporary()
    named = {"ca-file": made.tls_ca_file}
    for role in ("scheduler", "worker", "client"):
        found = made.get_tls_config_for_role(role)
        named |= {f"{role}.cert": found["cert"], f"{role}.key": found["key"]}
    for name, text in named.items():
        (folder / f"{name}.pem").write_text(text)
    files = {f"distributed.comm.tls.{name}": str(folder / f"{name}.pem") for name in named}
    with dask.config.set(files):
        yield [
            "--protocol", "tls", "--tls-ca-file", str(folder / "ca-file.pem"), "--tls-cert",
            str(folder / "scheduler.cert.pem"), "--tls-key", str(folder / "scheduler.key.pem"),
        ]  # fmt: skip


@pytest.mark.thorough
def test_a_cluster_with_certificates_and_one_without(tmp_path: Path):
    small: dict[str, Any] = {"spin": [1.0, 2.0], "speed": [1.0, 3.0]}
    with certificates(tmp_path) as options, cluster(tmp_path, 1, options) as (address, _):
        assert address.startswith("tls://")
        kept = PUCK.sweep(**small, store=tmp_path / "m.zarr", cluster=address)
        assert kept.load() == PUCK.sweep(**small)
        nowhere = dask.config.set({"distributed.comm.tls.ca-file": str(tmp_path / "none.pem")})
        with nowhere, pytest.raises(ClusterError, match="cannot be used"):
            PUCK.sweep(**small, store=tmp_path / "n.zarr", cluster=address)
        with certificates(tmp_path), pytest.raises(ClusterError, match="no scheduler answers"):
            PUCK.sweep(**small, store=tmp_path / "n.zarr", cluster=address)  # of another
    with pytest.raises(ClusterError, match="needs certificates"):
        PUCK.sweep(**small, store=tmp_path / "n.zarr", cluster="tls://127.0.0.1:9")


@pytest.mark.thorough
def test_nobody_without_its_certificate_reaches_a_cluster_of_ones_own():
    with client_of("local:1") as client:
        assert client.submit(sum, (1, 2)).result() == 3
        address = client.scheduler.address
        workers = list(client.scheduler_info()["workers"])
        assert address.startswith("tls://127.0.0.1:")
        stranger = distributed.security.Security.temporary().get_connection_args("client")
        nobody, other = ssl.create_default_context(), stranger["ssl_context"]
        for context in (nobody, other):
            context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        for one in (address, *workers, *(info["nanny"] for info in
                    client.scheduler_info()["workers"].values())):  # fmt: skip
            assert one.startswith("tls://")
            for context in (None, nobody, other):
                assert _answer(one, context)[:1] in (b"", _ALERT)


_ALERT = b"\x15"  # of TLS: the last that is said


def _answer(where: str, context: ssl.SSLContext | None) -> bytes:
    """What comes back to who talks there, plainly or by TLS."""
    host, port = where.rpartition("/")[2].rsplit(":", 1)
    with socket.create_connection((host, int(port)), 20.0) as plain:
        try:
            talk = plain if context is None else context.wrap_socket(plain)
            talk.sendall(bytes(64))
            return talk.recv(64)
        except (ssl.SSLError, ConnectionError):
            return b""


ANSWERS = (
    b"", b"SSH-2.0-OpenSSH_9.6\r\n", b"HTTP/1.1 400 Bad Request\r\n\r\n", bytes(64), b"\1" * 8,
)  # fmt: skip


@pytest.mark.thorough
@pytest.mark.parametrize("answer", few(2, ANSWERS))
def test_where_something_else_answers_it_is_said(answer: str, tmp_path: Path):
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve() -> None:
            with contextlib.suppress(OSError):
                while True:
                    kept.append(server.accept()[0])
                    kept[-1].sendall(ANSWERS[answer])

        kept: list[socket.socket] = []
        threading.Thread(target=serve, daemon=True).start()
        where = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        with pytest.raises(ClusterError, match=f"no scheduler answers at {where}"):
            PUCK.sweep([1.0], 1.0, store=tmp_path / "m.zarr", cluster=where)
        for one in kept:
            one.close()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.nightly
@pytest.mark.parametrize("when", ["at first", "in the middle"])
def test_a_frozen_scheduler_is_told_and_the_same_command_goes_on(when: str, tmp_path: Path):
    with cluster(tmp_path, 1) as (address, processes):
        scheduler = processes[0]

        def freeze(done: int, total: int) -> None:
            scheduler.send_signal(signal.SIGSTOP)

        if when == "at first":
            freeze(0, 1)
        with pytest.raises(ClusterError, match="answer"):
            PUCK.sweep(**SLOW, store=tmp_path / "m.zarr", cluster=address, progress=freeze)
        scheduler.send_signal(signal.SIGCONT)
        kept = PUCK.sweep(**SLOW, store=tmp_path / "m.zarr", cluster=address)
        assert sum(kept.tally.counts.values()) == 160 * 160


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(4))
def test_workers_killed_while_they_start_are_a_sentence(seed: int, tmp_path: Path):
    draw, code = random.Random(seed), "from puck_tables.cli.start import main; main()"
    words = ["sweep", "--w0", "0:5:100", "-o", "m.zarr", "--cluster", "local:2"]
    client = subprocess.Popen(
        [sys.executable, "-c", code, *words], cwd=tmp_path, stderr=subprocess.PIPE, text=True
    )

    def workers() -> list[int]:
        found = subprocess.run(
            ["pgrep", "-P", str(client.pid), "-f", "spawn_main"], capture_output=True, text=True
        )
        return list(map(int, found.stdout.split()))

    waited_for(lambda: workers() or client.poll() is not None)
    time.sleep(draw.uniform(0.0, 3.0))
    for worker in draw.sample(workers(), min(len(workers()), draw.randint(1, 2))):
        with contextlib.suppress(ProcessLookupError):
            os.kill(worker, signal.SIGKILL)
    said = client.communicate(timeout=120)[1]
    assert "Traceback" not in said, said
    assert client.returncode == 0 or said.splitlines()[-1].startswith("Error: "), said
