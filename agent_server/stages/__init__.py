"""The way from frames to a decision: synchronous steps without a clock of their own."""
