"""The Python client: sensors, renderers and monitors that survive bad networks.

:class:`Sensor`, :class:`Renderer` and :class:`Monitor` come back after a lost connection and
resume, as docs/clients.md has it; :func:`join` is one connection and no more, for tools.
"""

from agent_server.client.link import Options, Phase
from agent_server.client.monitor import Monitor
from agent_server.client.once import Client, ConnectionFailed, join, send_paced
from agent_server.client.renderer import Cancelled, Renderer
from agent_server.client.sensor import Sensor
from agent_server.client.timed import TimedRenderer

__all__ = [
    "Cancelled",
    "Client",
    "ConnectionFailed",
    "Monitor",
    "Options",
    "Phase",
    "Renderer",
    "Sensor",
    "TimedRenderer",
    "join",
    "send_paced",
]
