# syntax=docker/dockerfile:1
# Two stages: one with pip and a network makes /opt/agent-server, the other only holds it.
# Releases name both images with their digests: --build-arg RUNTIME_IMAGE=NAME@sha256:...
ARG BUILD_IMAGE=python:3.11.14-slim-bookworm
# Debian's Python 3.11 and the libraries that it needs: no shell, no package manager.
ARG RUNTIME_IMAGE=gcr.io/distroless/python3-debian12:nonroot

FROM ${BUILD_IMAGE} AS build
WORKDIR /src
COPY . .
# What is removed is there twice or never run: onnxruntime's library for C beside the one inside its
# Python module, its tools for making models, zstandard's second backend, packages' own tests, and
# what only type checkers read.
RUN python3 -m venv /build \
 && /build/bin/pip install --no-cache-dir --target /opt/agent-server '.[otel]' \
 && rm -rf /opt/agent-server/bin \
      /opt/agent-server/onnxruntime/capi/libonnxruntime.so* \
      /opt/agent-server/onnxruntime/quantization \
      /opt/agent-server/onnxruntime/tools \
      /opt/agent-server/onnxruntime/transformers \
      /opt/agent-server/zstandard/_cffi.*.so \
 && find /opt/agent-server -type d -name tests -prune -exec rm -r {} + \
 && find /opt/agent-server -name "*.pyi" -delete
# The models give their golden outputs with what is left, or there is no image.
WORKDIR /opt/agent-server
RUN python3 -m agent_server doctor --only models --only page

FROM ${RUNTIME_IMAGE}
ARG VERSION=0.1.0
ARG REVISION=unknown
LABEL org.opencontainers.image.title="agent-server" \
      org.opencontainers.image.description="Lets a virtual agent read a person's body and face, and react" \
      org.opencontainers.image.licenses="Apache-2.0" \
      org.opencontainers.image.version="${VERSION}" \
      org.opencontainers.image.revision="${REVISION}"
COPY --from=build /opt/agent-server /opt/agent-server
ENV PYTHONPATH=/opt/agent-server PYTHONDONTWRITEBYTECODE=1 PYTHONUNBUFFERED=1
USER 65532:65532
EXPOSE 8765
STOPSIGNAL SIGTERM
HEALTHCHECK --interval=10s --timeout=3s --start-period=10s \
  CMD ["/usr/bin/python3", "-c", "from urllib.request import urlopen; urlopen('http://127.0.0.1:8765/readyz', timeout=2)"]
ENTRYPOINT ["/usr/bin/python3", "-m", "agent_server"]
CMD ["--verbose", "--log-format", "json", "serve", "--host", "0.0.0.0"]
