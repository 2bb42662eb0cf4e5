"""``python -m agent_server``."""

from agent_server.cli.main import main

main()
