"""TurtleBot3 of the corpus, labels of the paper's map of costs, and the message types of its channels."""

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
# Message types as the packages of Navigation2, Gazebo and TurtleBot3 define them for these names (of Foxy).
TYPES = """labels: 1
topics:
  /amcl_pose: {types: [geometry_msgs/msg/PoseWithCovarianceStamped]}
  /behavior_tree_log: {types: [nav2_msgs/msg/BehaviorTreeLog]}
  /clicked_point: {types: [geometry_msgs/msg/PointStamped]}
  /clock: {types: [rosgraph_msgs/msg/Clock]}
  /cmd_vel: {types: [geometry_msgs/msg/Twist]}
  /cost_cloud: {types: [sensor_msgs/msg/PointCloud]}
  /evaluation: {types: [dwb_msgs/msg/LocalPlanEvaluation]}
  /global_costmap/costmap: {types: [nav_msgs/msg/OccupancyGrid]}
  /global_costmap/costmap_raw: {types: [nav2_msgs/msg/Costmap]}
  /global_costmap/costmap_updates: {types: [map_msgs/msg/OccupancyGridUpdate]}
  /global_costmap/footprint: {types: [geometry_msgs/msg/Polygon]}
  /global_costmap/published_footprint: {types: [geometry_msgs/msg/PolygonStamped]}
  /goal_pose: {types: [geometry_msgs/msg/PoseStamped]}
  /imu: {types: [sensor_msgs/msg/Imu]}
  /initialpose: {types: [geometry_msgs/msg/PoseWithCovarianceStamped]}
  /local_costmap/costmap: {types: [nav_msgs/msg/OccupancyGrid]}
  /local_costmap/costmap_raw: {types: [nav2_msgs/msg/Costmap]}
  /local_costmap/costmap_updates: {types: [map_msgs/msg/OccupancyGridUpdate]}
  /local_costmap/footprint: {types: [geometry_msgs/msg/Polygon]}
  /local_costmap/published_footprint: {types: [geometry_msgs/msg/PolygonStamped]}
  /local_plan: {types: [nav_msgs/msg/Path]}
  /map: {types: [nav_msgs/msg/OccupancyGrid]}
  /map_metadata: {types: [nav_msgs/msg/MapMetaData]}
  /map_updates: {types: [map_msgs/msg/OccupancyGridUpdate]}
  /odom: {types: [nav_msgs/msg/Odometry]}
  /particlecloud: {types: [geometry_msgs/msg/PoseArray]}
  /plan: {types: [nav_msgs/msg/Path]}
  /received_global_plan: {types: [nav_msgs/msg/Path]}
  /robot_description: {types: [std_msgs/msg/String]}
  /scan: {types: [sensor_msgs/msg/LaserScan]}
  /tf: {types: [tf2_msgs/msg/TFMessage]}
  /tf_static: {types: [tf2_msgs/msg/TFMessage]}
  /transformed_global_plan: {types: [nav_msgs/msg/Path]}
  /waypoints: {types: [visualization_msgs/msg/MarkerArray]}
services:
  /dynamic_map: {types: [nav_msgs/srv/GetMap]}
  /*/is_active: {types: [std_srvs/srv/Trigger]}
  /*/manage_nodes: {types: [nav2_msgs/srv/ManageLifecycleNodes]}
  /map_server/map: {types: [nav_msgs/srv/GetMap]}
  /map_server/load_map: {types: [nav2_msgs/srv/LoadMap]}
  /map_saver/save_map: {types: [nav2_msgs/srv/SaveMap]}
  /pause_physics: {types: [std_srvs/srv/Empty]}
  /reinitialize_global_localization: {types: [std_srvs/srv/Empty]}
  /request_nomotion_update: {types: [std_srvs/srv/Empty]}
  /reset_simulation: {types: [std_srvs/srv/Empty]}
  /reset_world: {types: [std_srvs/srv/Empty]}
  /unpause_physics: {types: [std_srvs/srv/Empty]}
actions:
  /backup: {types: [nav2_msgs/action/BackUp]}
  /compute_path_to_pose: {types: [nav2_msgs/action/ComputePathToPose]}
  /follow_path: {types: [nav2_msgs/action/FollowPath]}
  /FollowWaypoints: {types: [nav2_msgs/action/FollowWaypoints]}
  /navigate_to_pose: {types: [nav2_msgs/action/NavigateToPose]}
  /spin: {types: [nav2_msgs/action/Spin]}
  /wait: {types: [nav2_msgs/action/Wait]}
"""
