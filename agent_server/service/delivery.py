"""Commands on their way to the renderer, and what it answers: each takes effect once.

The room knows what is open; this part sees to it that a command is written down before it is
sent, that a renderer that comes back gets what is not over, and that all are told how it ended.
"""

import logging
from collections.abc import Iterable

import msgspec

from agent_server.domain.command import Command, CommandEnd
from agent_server.domain.scene import Authority, ObjectChanged
from agent_server.domain.stamp import NS_PER_MS
from agent_server.protocol import convert
from agent_server.protocol import messages as m
from agent_server.recording.records import RendererChanged, Restored
from agent_server.service.audience import Client
from agent_server.service.context import Context
from agent_server.service.reactions import Reactions
from agent_server.service.store import Saved, SessionStore

log = logging.getLogger(__name__)


class Delivery:
    """The renderer's side of a session.

    Args:
        context: The session.
        store: Where it is remembered over a restart.
        ledger: Within it, an id means one command for good.
        epoch: Changes with every opening of the session.
        resume_ns: How long a renderer whose connection broke keeps its place.
        reactions: What makes the motion of commands that ask for it.
    """

    def __init__(
        self,
        context: Context,
        store: SessionStore,
        ledger: str,
        epoch: str,
        resume_ns: int,
        reactions: Reactions,
    ) -> None:
        self._context = context
        self._store = store
        self._resume_ns = resume_ns
        self._reactions = reactions
        self.ledger = ledger
        self.epoch = epoch
        self.sequence = 0
        self._latest: m.CommandMessage | None = None
        self._shown = self.scene()
        self._broken_ns: int | None = None  # since when the acting renderer is missed

    def scene(self) -> m.SceneState:
        """The room as it is."""
        return convert.scene_message(self._context.core.scene())

    def restore(self, saved: Saved) -> None:
        """Go on where the session has stopped, before any client has come."""
        context = self._context
        arrival_ns = context.clock.now_ns()
        away_ns = max(0, context.clock.wall_ns() - saved.wall_ns)
        room = saved.room
        context.timeline.resume(room.now_ns + away_ns, arrival_ns)
        context.journal.append_core(Restored(room.now_ns, room))
        context.core.restore(room)
        self.sequence = room.sequence
        self._shown = self.scene()
        if room.command is not None:
            self._latest = convert.command_message(room.command, self.epoch, arrival_ns)
        if room.has_renderer:
            self._broken_ns = arrival_ns
        context.counters["restores"] += 1

    # ------------------------------------------------------------------ the renderer

    def hand_over(self, renderer: Client) -> None:
        """Let the renderer that has the seat act, from what is not over on."""
        context = self._context
        self._broken_ns = None
        now_ns = context.now()
        context.journal.append_core(RendererChanged(now_ns, attached=True))
        issued = context.core.set_renderer(True, now_ns)
        self.deliver(issued, now_ns)
        self._save()
        self._reconcile(renderer, now_ns)
        latest = self._latest
        if latest is None or latest.id != self.scene().command_id or issued:
            return
        age_ms = max(0, now_ns - latest.issued_ns) // NS_PER_MS
        renderer.outbox.post(msgspec.structs.replace(latest, epoch=self.epoch, age_ms=age_ms))
        context.counters["resent_commands"] += 1

    def lose(self, *, for_good: bool) -> None:
        """The acting renderer has left: for good, or its connection broke."""
        if for_good:
            self._detach()
        else:
            self._broken_ns = self._context.clock.now_ns()

    def wait_no_longer(self) -> None:
        """Let the room run by itself when a renderer has not come back in time."""
        broken_ns = self._broken_ns
        if broken_ns is not None and self._context.clock.now_ns() - broken_ns >= self._resume_ns:
            self._detach()

    def _detach(self) -> None:
        context = self._context
        self._broken_ns = None
        now_ns = context.now()
        context.journal.append_core(RendererChanged(now_ns, attached=False))
        self.deliver(context.core.set_renderer(False, now_ns), now_ns)
        self._save()

    def receive(self, client: Client, message: m.Message) -> None:
        """Take a renderer's message.

        Raises:
            InvalidInput: If it is refused; the room has not seen it then.
        """
        self._context.seats.require_room(client)
        match message:
            case m.AckMessage():
                self._take_ack(client, message)
            case m.SceneEvent():
                self.change(ObjectChanged(self._context.now(), message.object, message.state))

    def _take_ack(self, client: Client, message: m.AckMessage) -> None:
        context = self._context
        arrival_ns = context.clock.now_ns()
        ack = convert.ack_from_message(message, context.timeline.now(arrival_ns))
        heard = context.core.acknowledge(ack)
        context.counters["acks" if heard.taken else "stale_acks"] += 1
        context.journal.append_input(ack, arrival_ns)
        self.deliver(heard.commands, ack.stamp_ns)
        if heard.taken:
            self._save()
        elif message.status == "done":
            # It was over already, and what the renderer shows of it does not hold.
            client.outbox.update("scene", self.scene())
        context.audience.show(
            "ack",
            m.AckTelemetry(message.command_id, message.status, message.step, message.reason),
            # A word that comes too late does not take the place of how the command ended.
            message.command_id if heard.taken else f"{message.command_id} late",
        )

    def change(self, event: ObjectChanged) -> None:
        """Take over an object's state that somebody set by hand.

        Raises:
            InvalidInput: If the room has no such object or state.
        """
        context = self._context
        arrival_ns = context.clock.now_ns()
        commands = context.core.change_object(event)
        context.counters["scene_events"] += 1
        context.journal.append_input(event, arrival_ns)
        self.deliver(commands, event.stamp_ns)

    def _reconcile(self, renderer: Client, now_ns: int) -> None:
        """Settle where the renderer shows something else than the room holds."""
        differences = self._context.core.compare(renderer.hello.objects or {})
        for one in differences:
            if one.kept is Authority.RENDERER:
                self.change(ObjectChanged(now_ns, one.object, one.renderer))
        renderer.differences = [
            m.Difference(one.object, one.renderer, one.server, one.kept.value)
            for one in differences
        ]
        if differences:
            self._context.counters["scene_differences"] += len(differences)
            told = "; ".join(
                f"{one.object}: the renderer shows {one.renderer}, the room holds "
                f"{one.server or 'no such object'}, kept: {one.kept.value}"
                for one in differences
            )
            log.warning("session %s: %s", self._context.id, told)
            self._context.audience.show("error", m.ErrorMessage("scene_differs", told))

    # ------------------------------------------------------------------ commands

    def deliver(self, commands: Iterable[Command], now_ns: int) -> None:
        """Write down and send commands, and the room and what has ended where that has changed."""
        context = self._context
        decided_ns = context.clock.now_ns()
        commands = tuple(commands)
        messages = [convert.command_message(one, self.epoch, decided_ns) for one in commands]
        scene = self.scene()
        if messages:
            self._latest = messages[-1]
            self.sequence = self._latest.sequence
        if messages or scene != self._shown:
            self._save()
        for message in messages:
            context.counters["commands"] += 1
            context.audience.order(message)
            context.journal.append_output(message, message.issued_ns)
        for command in commands:
            self._reactions.begin(command)
        if scene != self._shown:
            self._shown = scene
            context.audience.show_scene(scene)
            context.journal.append_output(scene, now_ns)
        self._tell_endings()

    def _tell_endings(self) -> None:
        """Say how commands ended of which the renderer did not say it itself."""
        for ending in self._context.core.take_endings():
            self._context.counters[f"commands_{ending.end}"] += 1
            self._reactions.end(ending.command_id)
            if ending.end not in (CommandEnd.DONE, CommandEnd.FAILED):
                told = m.AckTelemetry(ending.command_id, ending.end.value)
                self._context.audience.show("ack", told, ending.command_id)

    def _save(self) -> None:
        context = self._context
        self._store.save(
            Saved(context.id, self.ledger, context.clock.wall_ns(), context.core.room_state())
        )
