"""A network with what updates it: optimiser, learning rate and averaged weights."""

from collections.abc import Callable, Mapping
from typing import Any

import torch
from torch import nn

from models.training.ema import Ema


class Updater:
    """Takes losses, and can be saved and restored.

    Args:
        network: What is trained, on its device.
        optimizer: Of its parameters.
        rate: Update -> factor on the learning rate.
        ema: Decay of the averaged weights.
        clip: Largest norm of the gradient.
    """

    def __init__(
        self,
        network: nn.Module,
        optimizer: torch.optim.Optimizer,
        rate: Callable[[int], float],
        ema: float,
        clip: float,
    ) -> None:
        self.network, self.optimizer, self.clip = network, optimizer, clip
        self.ema = Ema(network, ema)
        self.schedule = torch.optim.lr_scheduler.LambdaLR(optimizer, rate)

    def apply(self, loss: torch.Tensor) -> None:
        """One update."""
        self.optimizer.zero_grad(set_to_none=True)
        torch.autograd.backward(loss)
        nn.utils.clip_grad_norm_(self.network.parameters(), self.clip)
        self.optimizer.step()
        self.schedule.step()
        self.ema.update(self.network)

    def best(self) -> dict[str, Any]:
        """The averaged weights, as a checkpoint keeps them."""
        return {"network": self.ema.network.state_dict()}

    def state(self) -> dict[str, Any]:
        """Everything that a resumed run needs, in plain tensors and numbers."""
        return {
            "network": self.network.state_dict(),
            "ema": self.ema.network.state_dict(),
            "ema_updates": self.ema.updates,
            "optimizer": self.optimizer.state_dict(),
            "schedule": self.schedule.state_dict(),
        }

    def load(self, state: Mapping[str, Any]) -> None:
        """Go on from :meth:`state`."""
        self.network.load_state_dict(state["network"])
        self.ema.network.load_state_dict(state["ema"])
        self.ema.updates = state["ema_updates"]
        self.optimizer.load_state_dict(state["optimizer"])
        self.schedule.load_state_dict(state["schedule"])
