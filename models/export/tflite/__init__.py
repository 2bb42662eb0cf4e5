"""From tflite files with float weights to ONNX."""
