// name: reaching-leak
// kind: path
// description: Which sources reach one leak, with which kind of data?
// param leak: element, name of the leak, such as /uplink
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// returns robot: string, name of the robot of the source
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns pseudonymised: boolean, whether it arrives in pseudonymised form only
// returns dismissed: boolean, whether every path goes through another leak of the category
// returns disjoint_paths: integer, how many paths share no flow
// returns path: list of string, names on a shortest path in the order of the flow, source first
// returns leak_robot: string, name of the robot of the leak, which may be another one
// order: robot, category, source, leak_robot
MATCH (f:Finding {kind: 'disclosure', leak: $leak})-[a:ACROSS]->(e:Element)
WHERE $robot = '' OR f.robot = $robot OR f.leak_robot = $robot
WITH f, a, e ORDER BY a.step
WITH f, collect(e.name) AS path
RETURN f.robot AS robot, f.category AS category, f.source AS source, f.pseudonymised AS pseudonymised,
       f.dismissed AS dismissed, f.disjoint_paths AS disjoint_paths, path,
       f.leak_robot AS leak_robot
ORDER BY robot, category, source, leak_robot
