"""Sessions at run time: the only layer, with transports and cli, that awaits."""
