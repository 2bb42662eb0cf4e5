"""Model bundles: what they promise, and running them."""

import os

# onnxruntime tells its makers of its use unless this is said before it is imported.
os.environ["ORT_DISABLE_TELEMETRY"] = "1"
