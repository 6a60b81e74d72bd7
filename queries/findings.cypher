// name: findings
// kind: table
// description: What was found: which kind of data gets from which source to which leak, on which robot?
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// param category: category, only this category, narrower ones and what may be of it; all of them if it is empty, default ""
// returns robot: string, name of the robot of the source
// returns verdict: string, of that robot: leak, undetermined or no-leak-found
// returns kind: string, kind of finding, such as disclosure
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns leak: string, where it gets out
// returns pseudonymised: boolean, whether it arrives in pseudonymised form only
// returns dismissed: boolean, whether every path goes through another leak of the category
// returns disjoint_paths: integer, how many paths share no flow
// returns pattern: string, the same on every robot that has this finding
// returns leak_robot: string, name of the robot of the leak, which may be another one
// returns may_be: boolean, whether the data only may be of the category asked for: its own is broader, or overlaps with it
// order: robot, category, source, leak, leak_robot, kind
MATCH (c:DataCategory)
WHERE $category = '' OR EXISTS { (c)<-[:BROADER*0..]-()-[:BROADER*0..]->(:DataCategory {name: $category}) }
WITH c, $category <> '' AND NOT EXISTS { (c)-[:BROADER*0..]->(:DataCategory {name: $category}) } AS may_be
MATCH (c)<-[:OF_CATEGORY]-(f:Finding)
WHERE $robot = '' OR f.robot = $robot OR f.leak_robot = $robot
OPTIONAL MATCH (r:Robot {name: f.robot})
RETURN f.robot AS robot, r.verdict AS verdict, f.kind AS kind, f.category AS category, f.source AS source,
       f.leak AS leak, f.pseudonymised AS pseudonymised, f.dismissed AS dismissed,
       f.disjoint_paths AS disjoint_paths, f.pattern AS pattern, f.leak_robot AS leak_robot, may_be
ORDER BY robot, category, source, leak, leak_robot, kind
