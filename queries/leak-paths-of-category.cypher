// name: leak-paths-of-category
// kind: path
// description: Which sources of a category, of a narrower one or of data that may be of it, reach which leaks, and along which shortest path?
// param category: category, a category's name, such as Biometric
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
WHERE EXISTS { (c)<-[:BROADER*0..]-()-[:BROADER*0..]->(:DataCategory {name: $category}) }
WITH c, NOT EXISTS { (c)-[:BROADER*0..]->(:DataCategory {name: $category}) } AS may_be
MATCH (c)<-[:SOURCE_OF|DERIVES]-(start:Element)
WITH DISTINCT c.name AS kind, may_be, start
CALL (kind, start) {
  WITH * WHERE kind IN start.begins AND kind IN start.leaks
  RETURN start AS source, start AS leak, [start.name] AS path, [] AS policy
UNION
  MATCH p = ANY SHORTEST (start)-[first:FLOWS_TO WHERE kind IN first.begins]->()
            ((x)-[f:FLOWS_TO WHERE kind IN f.passes AND NOT kind IN x.leaks]->()){0,}
            (leak:Element WHERE kind IN leak.leaks)
  WITH *, [r IN relationships(p)  // the two sides of a wildcard are shown as one
           WHERE r.role IS NULL OR r.role <> 'matches' OR startNode(r).name <> endNode(r).name] AS steps
  RETURN start AS source, leak, [start.name] + [r IN steps | endNode(r).name] AS path,
         [r IN steps | coalesce(r.file + ':' + r.line, CASE r.role WHEN 'matches' THEN 'wildcard' ELSE 'by hand' END)]
         AS policy
UNION
  MATCH (start)-[d:DERIVES_FROM {category: kind, past_leak: false}]->(source)
  WHERE kind IN start.leaks
  RETURN source, start AS leak, d.way AS path, d.policy AS policy
UNION
  MATCH (start)-[d:DERIVES_FROM {category: kind, past_leak: false}]->(source)
  WHERE NOT kind IN start.leaks
  MATCH p = ANY SHORTEST (start)-[first:FLOWS_TO WHERE kind IN first.made]->()
            ((x)-[f:FLOWS_TO WHERE kind IN f.passes AND NOT kind IN x.leaks]->()){0,}
            (leak:Element WHERE kind IN leak.leaks)
  WITH *, [r IN relationships(p)
           WHERE r.role IS NULL OR r.role <> 'matches' OR startNode(r).name <> endNode(r).name] AS steps
  RETURN source, leak, d.way + [r IN steps | endNode(r).name] AS path,
         d.policy + [r IN steps | coalesce(r.file + ':' + r.line,
                                           CASE r.role WHEN 'matches' THEN 'wildcard' ELSE 'by hand' END)] AS policy
}
WITH kind, may_be, source, leak, path, policy ORDER BY size(path), path
WITH kind, may_be, source, leak, collect({path: path, policy: policy})[0] AS way
RETURN source.robot AS robot, kind AS category, source.name AS source, leak.name AS leak,
       way.path AS path, [line IN way.policy | CASE line WHEN '' THEN 'wildcard' ELSE line END] AS policy,
       leak.robot AS leak_robot, may_be
ORDER BY robot, category, source, leak, leak_robot
