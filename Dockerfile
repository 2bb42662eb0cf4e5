# syntax=docker/dockerfile:1
ARG PYTHON_IMAGE=python:3.11-slim-bookworm

FROM ${PYTHON_IMAGE} AS build
WORKDIR /src
COPY . .
RUN python -m venv /opt/agent-server \
 && /opt/agent-server/bin/pip install --no-cache-dir .

FROM ${PYTHON_IMAGE}
LABEL org.opencontainers.image.title="agent-server" \
      org.opencontainers.image.description="Lets a virtual agent read a person's body and face, and react" \
      org.opencontainers.image.licenses="Apache-2.0"
RUN useradd --system --uid 10001 agent
COPY --from=build /opt/agent-server /opt/agent-server
USER agent
EXPOSE 8765
HEALTHCHECK --interval=10s --timeout=3s --start-period=10s \
  CMD ["/opt/agent-server/bin/python", "-c", "import urllib.request as u; u.urlopen('http://127.0.0.1:8765/readyz', timeout=2)"]
ENTRYPOINT ["/opt/agent-server/bin/agent-server"]
CMD ["serve", "--host", "0.0.0.0"]
