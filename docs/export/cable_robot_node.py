"""Node of ROS 2 that computes a cable robot: a worked example, with standard messages alone.

    ros2 run … or python3 cable_robot_node.py --ros-args -p robot_file:=robots/cogiro.toml

| Name | Type | Content |
|---|---|---|
| service `~/equilibrium` | std_srvs/Trigger | equilibrium at the state of the robot file, as JSON |
| topic `~/pose`, read | geometry_msgs/PoseStamped | pose of the platform |
| topic `~/cables`, written | sensor_msgs/JointState | for each pose: `position` unstrained lengths [m], `effort` tensions at the platform [N] |
| topic `~/lengths`, read | sensor_msgs/JointState | unstrained lengths by the names of the cables |
| topic `~/platform`, written | geometry_msgs/PoseStamped | pose at which the platform rests with these lengths |

A pose or lengths without equilibrium give a warning in the log, and nothing is written.
"""

import json

import funicular
import rclpy
from geometry_msgs.msg import PoseStamped
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger


class CableRobot(Node):
    """Statics of a cable robot."""

    def __init__(self) -> None:
        super().__init__("cable_robot")
        path = self.declare_parameter("robot_file", "robots/cogiro.toml").value
        self.robot = funicular.Robot.from_file(path)
        self.names = list(self.robot.cable_names)
        self.cables = self.create_publisher(JointState, "~/cables", 10)
        self.platform = self.create_publisher(PoseStamped, "~/platform", 10)
        self.create_subscription(PoseStamped, "~/pose", self.on_pose, 10)
        self.create_subscription(JointState, "~/lengths", self.on_lengths, 10)
        self.create_service(Trigger, "~/equilibrium", self.on_equilibrium)

    def on_equilibrium(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        try:
            response.message = json.dumps(self.robot.equilibrium().to_dict())
            response.success = True
        except funicular.Error as error:
            response.success, response.message = False, str(error)
        return response

    def on_pose(self, message: PoseStamped) -> None:
        at, turn = message.pose.position, message.pose.orientation
        try:
            pose = funicular.Pose([at.x, at.y, at.z], quaternion_wxyz=[turn.w, turn.x, turn.y, turn.z])
            rest = self.robot.equilibrium(pose=pose)
        except funicular.Error as error:
            self.get_logger().warning(f"no equilibrium at this pose: {error}")
            return
        found = JointState()
        found.header = message.header
        found.name = self.names
        found.position = rest.unstrained_length_m.tolist()
        found.effort = rest.tension_platform_n.tolist()
        self.cables.publish(found)

    def on_lengths(self, message: JointState) -> None:
        given = dict(zip(message.name, message.position))
        missing = [name for name in self.names if name not in given]
        if missing:
            self.get_logger().warning(f"the lengths of the cables {', '.join(missing)} are missing")
            return
        try:
            rest = self.robot.equilibrium(lengths_m=[given[name] for name in self.names])
        except funicular.Error as error:
            self.get_logger().warning(f"no equilibrium with these lengths: {error}")
            return
        found = PoseStamped()
        found.header = message.header
        place, turn = found.pose.position, found.pose.orientation
        place.x, place.y, place.z = rest.pose.position_m.tolist()
        turn.w, turn.x, turn.y, turn.z = rest.pose.quaternion_wxyz.tolist()
        self.platform.publish(found)


def main() -> None:
    rclpy.init()
    rclpy.spin(CableRobot())


if __name__ == "__main__":
    main()
