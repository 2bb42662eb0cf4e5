"""Torch networks as bundles: ONNX, golden values, manifest, card, each checked."""
