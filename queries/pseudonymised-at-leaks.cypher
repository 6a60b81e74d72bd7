// name: pseudonymised-at-leaks
// kind: path
// description: Which data reaches a leak pseudonymised past all other leaks, which is personal data still, and who did that?
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// returns robot: string, name of the robot of the source
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns leak: string, where it gets out
// returns by: list of string, who pseudonymises it on the shortest path
// returns path: list of string, names in the order of the flow, source first
// returns leak_robot: string, name of the robot of the leak, which may be another one
// order: robot, category, source, leak, leak_robot
MATCH (f:Finding {kind: 'disclosure', pseudonymised: true, dismissed: false})-[a:ACROSS]->(e:Element)
WHERE $robot = '' OR f.robot = $robot OR f.leak_robot = $robot
WITH f, a, e ORDER BY a.step
WITH f, collect(e.name) AS path, collect(a.pseudonymised) AS after
RETURN f.robot AS robot, f.category AS category, f.source AS source, f.leak AS leak,
       [i IN range(1, size(path) - 1) WHERE after[i] AND NOT after[i - 1] | path[i - 1]] AS by, path,
       f.leak_robot AS leak_robot
ORDER BY robot, category, source, leak, leak_robot
