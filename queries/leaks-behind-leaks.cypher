// name: leaks-behind-leaks
// kind: path
// description: Which leaks does a kind of data reach only through another leak of it, so that they were dismissed?
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// returns robot: string, name of the robot of the source
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns leak: string, the leak behind
// returns through: list of string, the leaks of the category that it goes through before, on the shortest path
// returns path: list of string, names in the order of the flow, source first
// returns pseudonymised: boolean, whether it arrives in pseudonymised form only
// returns leak_robot: string, name of the robot of the leak, which may be another one
// order: robot, category, source, leak, leak_robot
MATCH (f:Finding {dismissed: true})-[a:ACROSS]->(e:Element)
WHERE $robot = '' OR f.robot = $robot OR f.leak_robot = $robot
WITH f, a, e ORDER BY a.step
WITH f, collect(e) AS way, collect(a.category) AS kinds
RETURN f.robot AS robot, f.category AS category, f.source AS source, f.leak AS leak,
       [i IN range(1, size(way) - 2) WHERE f.category IN way[i].leaks AND f.category IN [kinds[i], kinds[i + 1]]
        | way[i].name] AS through,
       [e IN way | e.name] AS path, f.pseudonymised AS pseudonymised,
       f.leak_robot AS leak_robot
ORDER BY robot, category, source, leak, leak_robot
