// name: leak-paths
// kind: path
// description: Which sources reach which leaks, and along which shortest path? One for each finding that was loaded.
// param category: category, only this category, narrower ones and what may be of it; all of them if it is empty, default ""
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// returns robot: string, name of the source's robot
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns leak: string, where it gets out
// returns path: list of string, names in the order of the flow, source first
// returns policy: list of string, file:line of the policy line behind each step
// returns leak_robot: string, name of the robot of the leak, which may be another one
// returns may_be: boolean, whether the data only may be of the category asked for: its own is broader, or overlaps with it
// order: robot, category, source, leak, leak_robot
MATCH (c:DataCategory)
WHERE $category = '' OR EXISTS { (c)<-[:BROADER*0..]-()-[:BROADER*0..]->(:DataCategory {name: $category}) }
WITH c, $category <> '' AND NOT EXISTS { (c)-[:BROADER*0..]->(:DataCategory {name: $category}) } AS may_be
MATCH (c)<-[:OF_CATEGORY]-(f:Finding {kind: 'disclosure', dismissed: false})
WHERE $robot = '' OR f.robot = $robot OR f.leak_robot = $robot
MATCH (f)-[a:ACROSS]->(n:Element)
WITH f, may_be, a, n ORDER BY a.step
WITH f, may_be, collect(n.name) AS path,
     collect(CASE WHEN a.step = 0 THEN null WHEN a.file IS NULL THEN 'wildcard' ELSE a.file + ':' + a.line END) AS policy
RETURN f.robot AS robot, f.category AS category, f.source AS source, f.leak AS leak, path, policy,
       f.leak_robot AS leak_robot, may_be
ORDER BY robot, category, source, leak, leak_robot
