// name: findings-by-pattern
// kind: table
// description: Which findings, not counting dismissed ones, do how many robots have in common?
// param category: category, only this category, narrower ones and what may be of it; all of them if it is empty, default ""
// returns robots: integer, at how many robots it begins; of the infrastructure, or what else is shared, at none
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns leak: string, where it gets out
// returns kind: string, kind of finding, such as disclosure
// returns pseudonymised: integer, from how many of them it arrives in pseudonymised form only
// returns some_robots: list of string, the first five of them
// returns pattern: string, the same on every robot
// returns may_be: boolean, whether the data only may be of the category asked for: its own is broader, or overlaps with it
// order: robots DESC, category, source, leak, pattern
MATCH (c:DataCategory)
WHERE $category = '' OR EXISTS { (c)<-[:BROADER*0..]-()-[:BROADER*0..]->(:DataCategory {name: $category}) }
WITH c, $category <> '' AND NOT EXISTS { (c)-[:BROADER*0..]->(:DataCategory {name: $category}) } AS may_be
MATCH (c)<-[:OF_CATEGORY]-(f:Finding {dismissed: false})
OPTIONAL MATCH (r:Robot {name: f.robot}) WHERE r.shared IS NULL
WITH f, may_be, r.name AS robot ORDER BY robot
WITH f.pattern AS pattern, f.category AS category, f.source AS source, f.leak AS leak, f.kind AS kind, may_be,
     collect(DISTINCT robot) AS names, count(DISTINCT CASE WHEN f.pseudonymised THEN robot END) AS pseudonymised
RETURN size(names) AS robots, category, source, leak, kind, pseudonymised, names[..5] AS some_robots, pattern, may_be
ORDER BY robots DESC, category, source, leak, pattern
