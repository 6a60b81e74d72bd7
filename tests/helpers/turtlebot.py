"""TurtleBot3 of the corpus, and labels of the paper's map of costs."""

from __future__ import annotations

TURTLEBOT3 = "policies/ros-swg__turtlebot3_demo/policies/tb3_gazebo_policy.xml"
COSTMAP = """labels: 1
nodes:
  /root: {sanitizer: {HomeMap: drop}}  # an administrator's shell, not what the paper looks at
  /turtlebot3_laserscan: {source: [HomeMap]}
  /recoveries_server: {leak: [HomeMap]}
  /local_costmap/local_costmap_rclcpp_node: conduit
  /local_costmap/local_costmap: conduit
  /rviz2: conduit
  /amcl_rclcpp_node: conduit
  /amcl: conduit
  /slam_toolbox: conduit
  /global_costmap/*: conduit
channels:
  /scan: sensitive
  /map: sensitive
  /local_costmap/costmap_raw: sensitive
  /tf: mundane
  /FollowWaypoints: mundane
  /navigate_to_pose: mundane
  /global_costmap/clear_entirely_global_costmap: mundane
  /local_costmap/clear_entirely_local_costmap: mundane
  /local_costmap/published_footprint: mundane
"""
MEMORY = """
elements:
  costmap in memory:
    kind: side-channel
    between: [/local_costmap/local_costmap_rclcpp_node, /local_costmap/local_costmap]
"""
