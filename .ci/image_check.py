"""Start the image's server in its own root file system, read-only and as its own user.

``python3 .ci/image_check.py FOLDER`` reads what ``.ci/image`` has built there: entry point,
command, user, environment and health check are the image's, and the check runs inside too.
"""
# ruff: noqa: S603, S607, T201

import ctypes
import json
import os
import subprocess
import sys
import time
from pathlib import Path

LIMIT_MB = 450
START_S = 60.0
CLONE_NEWNS = 0x20000
MS_RDONLY, MS_REMOUNT, MS_BIND, MS_REC, MS_PRIVATE = 1, 32, 4096, 16384, 1 << 18


def buildah(folder, *arguments):
    """What buildah prints."""
    store = ("--storage-driver", "vfs", "--root", f"{folder}/storage", "--runroot", f"{folder}/run")
    run = subprocess.run(
        ["buildah", *store, *arguments], capture_output=True, text=True, check=True
    )
    return run.stdout.strip()


def mount(source, target, flags, kind=None):
    """The system call; raises OSError."""
    libc = ctypes.CDLL(None, use_errno=True)
    encoded = [None if text is None else os.fsencode(text) for text in (source, target, kind)]
    if libc.mount(*encoded, flags, None):
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()), target)


def inside(root, user):
    """What a child process does first: a read-only root with a /tmp of its own, no rights."""

    def enter():
        if ctypes.CDLL(None).unshare(CLONE_NEWNS):
            raise OSError("no mount namespace")
        mount(None, "/", MS_REC | MS_PRIVATE)
        mount(root, root, MS_BIND)
        for folder, kind in (("tmp", "tmpfs"), ("proc", "proc"), ("dev", "tmpfs")):
            mount(kind, f"{root}/{folder}", 0, kind)
        os.mknod(f"{root}/dev/null", 0o20666, os.makedev(1, 3))
        os.mknod(f"{root}/dev/urandom", 0o20444, os.makedev(1, 9))
        mount(None, root, MS_REMOUNT | MS_BIND | MS_RDONLY)
        os.chroot(root)
        os.chdir("/")
        number = int(user.split(":")[0])
        os.setgroups([])
        os.setgid(number)
        os.setuid(number)

    return enter


def main():
    """Check, and print one JSON object."""
    folder = sys.argv[1]
    told = json.loads(buildah(folder, "inspect", "--type", "image", "localhost/agent-server"))
    config = told["Docker"]["config"]
    container = buildah(folder, "from", "--pull-never", "localhost/agent-server")
    root = buildah(folder, "mount", container)
    base = buildah(folder, "from", "--pull-never", "localhost/runtime")
    sizes = [megabytes(path) for path in (root, buildah(folder, "mount", base))]
    environment = dict(entry.split("=", 1) for entry in config["Env"])
    command = [*config["Entrypoint"], *config["Cmd"], "--insecure"]
    enter = inside(root, config["User"])
    began_s = time.monotonic()
    server = subprocess.Popen(command, env=environment, preexec_fn=enter)  # noqa: PLW1509
    try:
        check = config["Healthcheck"]["Test"][1:]
        while subprocess.run(
            check, check=False, env=environment, preexec_fn=enter, capture_output=True
        ).returncode:
            if server.poll() is not None or time.monotonic() - began_s > START_S:
                sys.exit("the server in the image did not become healthy")
            time.sleep(0.1)
        healthy_s = time.monotonic() - began_s
        try:
            Path(f"/proc/{server.pid}/root/opt/written").touch()
            sys.exit("the root file system could be written")
        except OSError:
            pass
    finally:
        server.terminate()
        status = server.wait(15)
    added_mb = round(sizes[0] - sizes[1], 1)
    print(
        json.dumps(
            {
                "image_mb": sizes[0],
                "base_mb": sizes[1],
                "added_mb": added_mb,
                "user": config["User"],
                "healthy_s": round(healthy_s, 2),
                "stopped_with": status,
            }
        )
    )
    if sizes[0] >= LIMIT_MB:
        sys.exit(f"the image has {sizes[0]} MB, {LIMIT_MB} or more")


def megabytes(path):
    """What all files of a root file system take, in MB (10^6 bytes), as engines count it."""
    files = (one for one in Path(path).rglob("*") if one.is_file() and not one.is_symlink())
    return round(sum(file.lstat().st_size for file in files) / 1e6, 1)


if __name__ == "__main__":
    main()
