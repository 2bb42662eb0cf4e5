"""The examples of docs/deployment.md fit the server, the image and each other."""

import json
import re
from pathlib import Path

import pytest
from prometheus_client.parser import text_string_to_metric_families

from agent_server.service.hub import Hub
from agent_server.transports.app import OPEN_PATHS
from tests.support.live import live

yaml = pytest.importorskip("yaml")
ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples" / "deployment"
BOARD = json.loads((EXAMPLES / "grafana" / "agent-server.json").read_text())
ALERTS = yaml.safe_load((EXAMPLES / "alerts.yaml").read_text())
NAME = re.compile(r"\b(?:agent_server|process)_\w+")
LABEL = re.compile(r"\bby \(([^)]*)\)|\{\{\$?(?:labels\.)?(\w+)\}\}|(\w+)=\"")


def queries():
    """Everything that the dashboard and the alerts ask for."""
    for panel in BOARD["panels"]:
        for target in panel["targets"]:
            yield target["expr"], target["legendFormat"]
    for group in ALERTS["groups"]:
        for rule in group["rules"]:
            yield rule["expr"], ""


def labels_in(*texts):
    found = [group for text in texts for match in LABEL.findall(text) for group in match]
    return {one.strip() for group in found for one in group.split(",") if one.strip()}


async def test_every_figure_that_is_asked_for_exists_with_its_labels():
    async with live() as server:
        families = list(text_string_to_metric_families(server.hub.metrics.text().decode()))
    labels = {}
    for family in families:
        for sample in family.samples:
            labels.setdefault(sample.name, set()).update(sample.labels)
    asked = 0
    for expression, legend in queries():
        for name in NAME.findall(expression):
            asked += 1
            assert name in labels, f"{expression} asks for {name}, which the server has not"
            wanted = labels_in(expression, legend)
            assert wanted <= labels[name], f"{expression} asks for labels that {name} has not"
    assert asked > 30


def manifests():
    text = (EXAMPLES / "kubernetes" / "agent-server.yaml").read_text()
    return [one for one in yaml.safe_load_all(text) if one]


def of_kind(kind):
    return [one for one in manifests() if one["kind"] == kind]


def test_kubernetes_asks_for_paths_that_need_no_token():
    (stateful,) = of_kind("StatefulSet")
    (container,) = stateful["spec"]["template"]["spec"]["containers"]
    for probe in ("startupProbe", "readinessProbe", "livenessProbe"):
        assert container[probe]["httpGet"]["path"] in OPEN_PATHS
    assert container["readinessProbe"]["httpGet"]["path"] == "/readyz"
    # A server that is not ready, or drains, is not to be killed for it.
    assert container["livenessProbe"]["httpGet"]["path"] == "/healthz"


async def test_kubernetes_leaves_time_to_drain():
    (stateful,) = of_kind("StatefulSet")
    pod = stateful["spec"]["template"]["spec"]
    before_s = pod["containers"][0]["lifecycle"]["preStop"]["sleep"]["seconds"]
    async with live() as server:
        hub: Hub = server.hub
    assert pod["terminationGracePeriodSeconds"] > before_s + 2 * hub.settings.server.drain_s + 5


def test_kubernetes_manifests_fit_each_other():
    (stateful,) = of_kind("StatefulSet")
    (budget,) = of_kind("PodDisruptionBudget")
    labels = stateful["spec"]["template"]["metadata"]["labels"]
    assert stateful["spec"]["selector"]["matchLabels"] == labels
    assert budget["spec"]["selector"]["matchLabels"] == labels
    replicas = stateful["spec"]["replicas"]
    assert budget["spec"]["maxUnavailable"] < replicas
    services = {one["metadata"]["name"] for one in of_kind("Service")}
    (ingress,) = of_kind("Ingress")
    behind = [
        path["backend"]["service"]["name"]
        for rule in ingress["spec"]["rules"]
        for path in rule["http"]["paths"]
    ]
    assert behind == [f"agent-server-{index}" for index in range(replicas)]
    assert {*behind, stateful["spec"]["serviceName"]} == services


def test_containers_run_as_the_images_user_and_write_nothing_of_theirs():
    dockerfile = (ROOT / "Dockerfile").read_text()
    user = int(re.search(r"^USER (\d+):(\d+)$", dockerfile, re.MULTILINE)[1])
    (stateful,) = of_kind("StatefulSet")
    pod = stateful["spec"]["template"]["spec"]
    (container,) = pod["containers"]
    assert pod["securityContext"]["runAsUser"] == pod["securityContext"]["fsGroup"] == user != 0
    assert container["securityContext"]["readOnlyRootFilesystem"]
    server = compose()["services"]["agent-server"]
    assert server["read_only"]
    assert server["cap_drop"] == ["ALL"]
    assert f"{user}:{user}" in compose()["services"]["folders"]["command"]


def compose():
    return yaml.safe_load((ROOT / "compose.yaml").read_text())


def test_compose_mounts_files_that_are_there():
    made = set()
    for service in compose()["services"].values():
        for volume in service.get("volumes", []):
            source = volume.split(":")[0]
            if source.startswith("./"):
                assert (ROOT / source).is_file(), source
            else:
                made.add(source)
    assert made == set(compose()["volumes"])


def test_only_the_proxy_can_be_reached_from_outside():
    services = compose()["services"]
    assert [name for name, one in services.items() if "ports" in one] == ["caddy"]
    proxy = services["caddy"]["networks"]["inside"]["ipv4_address"]
    trusted = services["agent-server"]["environment"]["AGENT_SERVER__ACCESS__TRUSTED_PROXIES"]
    assert json.loads(trusted) == [proxy]
