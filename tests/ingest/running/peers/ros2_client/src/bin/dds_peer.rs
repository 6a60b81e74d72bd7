//! A ROS 2 robot on DDS that is not ours: four nodes of ros2-client (RustDDS), three in one participant, one in another.
//!
//! It says `ready`, and answers each line of standard input with `done` and who is seen in the domain beside itself:
//! how many participants, and which nodes. All that it sends stays on 127.0.0.1; `ROS_DOMAIN_ID` says in which domain.

use std::collections::{BTreeMap, BTreeSet};
use std::io::BufRead;
use std::sync::{Arc, Mutex};

use futures::StreamExt;
use ros2_client::dds::rustdds::{
    DomainParticipantBuilder, DomainParticipantStatusEvent, StatusEvented,
};
use ros2_client::dds::{Context, Node, NodeEvent, ServiceMapping};
use ros2_client::{
    ActionTypeName, Message, MessageTypeName, Name, NodeName, NodeOptions, QosProfile,
    ServiceTypeName, action::ActionServerQosPolicies,
};
use serde::{Deserialize, Serialize};

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Request {
    data: bool,
}
impl Message for Request {}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Response {
    success: bool,
    message: String,
}
impl Message for Response {}

fn context(domain: u16) -> Context {
    let here = [std::net::Ipv4Addr::LOCALHOST];
    let participant = DomainParticipantBuilder::new(domain)
        .with_only_networks(here)
        .build();
    Context::from_domain_participant(participant.unwrap()).unwrap()
}

fn node(context: &Context, namespace: &str, name: &str) -> Node {
    context
        .new_node(
            NodeName::new(namespace, name).unwrap(),
            NodeOptions::new().start_parameter_services(false),
        )
        .unwrap()
}

fn main() {
    let domain = std::env::var("ROS_DOMAIN_ID").unwrap().parse().unwrap();
    let (body, base) = (context(domain), context(domain));
    let qos = QosProfile::publisher_default();
    let save = Name::new("/", "save_footage").unwrap();
    let set_bool = ServiceTypeName::new("std_srvs", "SetBool");

    let mut camera = node(&body, "/head", "camera_driver");
    let image = Name::new("/head/camera", "image_raw").unwrap();
    let image = camera
        .create_topic(&image, MessageTypeName::new("sensor_msgs", "Image"), &qos)
        .unwrap();
    let frames = camera.create_publisher::<String>(&image, None).unwrap();

    let mut recognizer = node(&body, "/", "face_recognizer");
    let watched = recognizer
        .create_subscription::<String>(&image, None)
        .unwrap();
    let faces = Name::new("/", "faces").unwrap();
    let faces = recognizer
        .create_topic(&faces, MessageTypeName::new("hri_msgs", "IdsList"), &qos)
        .unwrap();
    let found = recognizer.create_publisher::<String>(&faces, None).unwrap();

    let mut archive = node(&body, "/", "archive");
    let known = archive.create_subscription::<String>(&faces, None).unwrap();
    let (asked, told) = (qos.clone(), qos.clone());
    let saving = archive
        .create_server::<Request, Response>(ServiceMapping::Enhanced, &save, &set_bool, asked, told)
        .unwrap();

    let mut navigator = node(&base, "/", "navigator");
    let (asked, told) = (qos.clone(), qos.clone());
    let saver = navigator
        .create_client::<Request, Response>(ServiceMapping::Enhanced, &save, &set_bool, asked, told)
        .unwrap();
    let parts = ActionServerQosPolicies {
        goal_service: qos.clone(),
        result_service: qos.clone(),
        cancel_service: qos.clone(),
        feedback_publisher: qos.clone(),
        status_publisher: qos.clone(),
    };
    let driving = navigator
        .create_action_server::<i32, i32, i32>(
            ServiceMapping::Enhanced,
            &Name::new("/", "navigate_to_pose").unwrap(),
            &ActionTypeName::new("nav2_msgs", "NavigateToPose"),
            parts,
        )
        .unwrap();

    let participants = Arc::new(Mutex::new(BTreeSet::new()));
    let nodes = Arc::new(Mutex::new(BTreeMap::new()));
    let executor = smol::Executor::new();
    // One participant listens for nodes, the other one for participants: what is heard is taken by one listener.
    executor.spawn(navigator.spinner().unwrap().spin()).detach();
    let events = navigator.status_receiver().unwrap();
    executor
        .spawn({
            let nodes = nodes.clone();
            events.for_each(move |event| {
                if let NodeEvent::ParticipantEntities(said) = event {
                    let names: Vec<_> = said
                        .nodes()
                        .iter()
                        .map(|one| one.fully_qualified_name())
                        .collect();
                    nodes.lock().unwrap().insert(said.gid(), names);
                }
                std::future::ready(())
            })
        })
        .detach();
    let listener = body.domain_participant().status_listener();
    let discovered = listener.as_async_status_stream().for_each({
        let participants = participants.clone();
        move |event| {
            if let DomainParticipantStatusEvent::ParticipantDiscovered { dpd } = event {
                participants.lock().unwrap().insert(dpd.guid);
            }
            std::future::ready(())
        }
    });
    std::thread::spawn(move || {
        println!("ready");
        for _ in std::io::stdin().lock().lines() {
            let seen: BTreeSet<_> = nodes.lock().unwrap().values().flatten().cloned().collect();
            let seen: Vec<_> = seen.into_iter().collect();
            println!(
                "done {} {}",
                participants.lock().unwrap().len(),
                seen.join(" ")
            );
        }
        std::process::exit(0);
    });
    smol::block_on(executor.run(discovered));
    drop((frames, watched, found, known, saving, saver, driving));
}
