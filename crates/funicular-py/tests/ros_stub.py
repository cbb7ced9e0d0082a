"""Stub of the parts of ROS 2 that docs/export/cable_robot_node.py uses. It is no ROS: nothing is sent anywhere, published
messages are kept in a list, and messages are plain objects with the fields of the standard definitions."""

import sys
import types
from collections.abc import Callable
from typing import Any


class Message:
    """Message whose fields are made at their first use: nested ones as messages, others as they are set."""

    nested = ("header", "pose", "position", "orientation")

    def __getattr__(self, name: str) -> Any:
        if name not in self.nested:
            raise AttributeError(f"the stub of this message has no field {name}")
        made = Message()
        setattr(self, name, made)
        return made


class Publisher:
    def __init__(self) -> None:
        self.sent: list[Any] = []

    def publish(self, message: Any) -> None:
        self.sent.append(message)


class Node:
    parameters: dict[str, Any] = {}

    def __init__(self, name: str) -> None:
        self.name, self.warned = name, list[str]()
        self.called: dict[str, Callable[..., Any]] = {}
        self.published: dict[str, Publisher] = {}

    def declare_parameter(self, name: str, default: Any) -> Any:
        return types.SimpleNamespace(value=self.parameters.get(name, default))

    def create_publisher(self, kind: type, topic: str, depth: int) -> Publisher:
        return self.published.setdefault(topic, Publisher())

    def create_subscription(self, kind: type, topic: str, call: Callable[..., Any], depth: int) -> None:
        self.called[topic] = call

    def create_service(self, kind: type, name: str, call: Callable[..., Any]) -> None:
        self.called[name] = call

    def get_logger(self) -> Any:
        return types.SimpleNamespace(warning=self.warned.append)


def install(patch: Callable[[dict[str, Any], str, Any], None]) -> None:
    """Puts the stub in the place of the modules; `patch` sets an entry of a dictionary and undoes it after the test."""
    kinds: dict[str, dict[str, Any]] = {
        "geometry_msgs.msg": {"PoseStamped": type("PoseStamped", (Message,), {})},
        "sensor_msgs.msg": {"JointState": type("JointState", (Message,), {"nested": ("header",)})},
        "std_srvs.srv": {"Trigger": types.SimpleNamespace(Request=types.SimpleNamespace, Response=types.SimpleNamespace)},
        "rclpy.node": {"Node": Node},
    }
    for name, content in kinds.items():
        package, module = types.ModuleType(name.split(".")[0]), types.ModuleType(name)
        vars(module).update(content)
        patch(sys.modules, package.__name__, package)
        patch(sys.modules, name, module)
