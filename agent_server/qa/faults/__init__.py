"""What goes wrong between a sensor and the core, done to a recording on purpose."""
