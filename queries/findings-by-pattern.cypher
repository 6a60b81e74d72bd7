// name: findings-by-pattern
// kind: table
// description: Which findings, not counting dismissed ones, do how many robots have in common?
// param category: category, only this category and narrower ones; all of them if it is empty, default ""
// returns robots: integer, how many robots have it
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns leak: string, where it gets out
// returns kind: string, kind of finding, such as disclosure
// returns pseudonymised: integer, on how many robots it arrives in pseudonymised form only
// returns some_robots: list of string, the first five of the robots
// returns pattern: string, the same on every robot
// order: robots DESC, category, source, leak, pattern
MATCH (f:Finding {dismissed: false})
WHERE $category = ''
   OR EXISTS { (f)-[:OF_CATEGORY]->(:DataCategory)-[:BROADER*0..]->(:DataCategory {name: $category}) }
WITH f ORDER BY f.robot
WITH f.pattern AS pattern, f.category AS category, f.source AS source, f.leak AS leak, f.kind AS kind,
     collect(DISTINCT f.robot) AS names,
     count(DISTINCT CASE WHEN f.pseudonymised THEN f.robot END) AS pseudonymised
RETURN size(names) AS robots, category, source, leak, kind, pseudonymised, names[..5] AS some_robots, pattern
ORDER BY robots DESC, category, source, leak, pattern
