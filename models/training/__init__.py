"""What every training run shares: seeds, averaged weights, checkpoints, progress."""
