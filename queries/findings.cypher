// name: findings
// kind: table
// description: What was found: which kind of data gets from which source to which leak, on which robot?
// param robot: robot, only this robot; all of them if it is empty, default ""
// param category: category, only this category and narrower ones; all of them if it is empty, default ""
// returns robot: string, name of the robot
// returns verdict: string, of the whole robot: leak, undetermined or no-leak-found
// returns kind: string, kind of finding, such as disclosure
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns leak: string, where it gets out
// returns pseudonymised: boolean, whether it arrives in pseudonymised form only
// returns dismissed: boolean, whether every path goes through another leak of the category
// returns disjoint_paths: integer, how many paths share no flow
// returns pattern: string, the same on every robot that has this finding
// order: robot, category, source, leak, kind
MATCH (f:Finding)
WHERE ($robot = '' OR f.robot = $robot)
  AND ($category = ''
       OR EXISTS { (f)-[:OF_CATEGORY]->(:DataCategory)-[:BROADER*0..]->(:DataCategory {name: $category}) })
OPTIONAL MATCH (r:Robot {name: f.robot})
RETURN f.robot AS robot, r.verdict AS verdict, f.kind AS kind, f.category AS category, f.source AS source,
       f.leak AS leak, f.pseudonymised AS pseudonymised, f.dismissed AS dismissed,
       f.disjoint_paths AS disjoint_paths, f.pattern AS pattern
ORDER BY robot, category, source, leak, kind
