//! A ROS 2 robot on Zenoh that is not ours: four nodes of ros2-client, with its own writing of rmw_zenoh's keys.
//!
//! It says `ready`, and answers each line of standard input with `done` and the nodes that are seen in the domain, its own
//! too. `ROS_DOMAIN_ID` says in which domain, `ZENOH_CONFIG_OVERRIDE` by which router.

use std::io::BufRead;

use ros2_client::zenoh::{Context, ContextOptions, Node};
use ros2_client::{
    ActionTypeName, MessageTypeName, Name, NodeName, NodeOptions, QosProfile, ServiceTypeName,
};
use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Request {
    data: bool,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Response {
    success: bool,
    message: String,
}

fn node(context: &Context, namespace: &str, name: &str) -> Node {
    let options = NodeOptions::new().start_parameter_services(false);
    context
        .new_node(NodeName::new(namespace, name).unwrap(), options)
        .unwrap()
}

fn main() {
    let domain = std::env::var("ROS_DOMAIN_ID").unwrap().parse().unwrap();
    let context = Context::with_options(ContextOptions::new().domain_id(domain)).unwrap();
    let qos = QosProfile::publisher_default();
    let save = Name::new("/", "save_footage").unwrap();
    let set_bool = ServiceTypeName::new("std_srvs", "SetBool");

    let camera = node(&context, "/head", "camera_driver");
    let image = Name::new("/head/camera", "image_raw").unwrap();
    let image = camera.create_topic(&image, MessageTypeName::new("sensor_msgs", "Image"), &qos);
    let frames = camera.create_publisher::<String>(&image, None).unwrap();

    let recognizer = node(&context, "/", "face_recognizer");
    let watched = recognizer
        .create_subscription::<String>(&image, None)
        .unwrap();
    let faces = Name::new("/", "faces").unwrap();
    let faces = recognizer.create_topic(&faces, MessageTypeName::new("hri_msgs", "IdsList"), &qos);
    let found = recognizer.create_publisher::<String>(&faces, None).unwrap();

    let archive = node(&context, "/", "archive");
    let known = archive.create_subscription::<String>(&faces, None).unwrap();
    let saving = archive
        .create_server::<Request, Response>(&save, &set_bool)
        .unwrap();

    let navigator = node(&context, "/", "navigator");
    let saver = navigator
        .create_client::<Request, Response>(&save, &set_bool)
        .unwrap();
    let driving = navigator
        .create_action_server::<i32, i32, i32>(
            &Name::new("/", "navigate_to_pose").unwrap(),
            &ActionTypeName::new("nav2_msgs", "NavigateToPose"),
        )
        .unwrap();

    println!("ready");
    for _ in std::io::stdin().lock().lines() {
        println!("done {}", context.node_names().join(" "));
    }
    drop((frames, watched, found, known, saving, saver, driving));
}
