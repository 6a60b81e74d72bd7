// name: sources-of-element
// kind: path
// description: From which sources does the data come that gets to one element, and along which path?
// param element: element, name of a node, topic, service, action or other element
// param robot: robot, only an element of this robot, or data that comes from it; all robots if it is empty, default ""
// returns robot: string, name of the element's robot
// returns kind: string, kind of the element
// returns category: string, the kind of data that gets here
// returns source: string, where it comes in, or where that comes in of which it is made on the way
// returns steps: integer, flows on the way; 0 if the element is the source
// returns path: list of string, names in the order of the flow, source first
// returns policy: list of string, file:line of the policy line behind each step
// returns source_robot: string, name of the robot of the source, which may be another one
// order: robot, kind, category, source, source_robot
MATCH (e:Element {name: $element})
WHERE size(e.carries) > 0
CALL (e) {
  UNWIND e.begins AS category
  RETURN category, e AS source, [e.name] AS path, [] AS policy
UNION
  MATCH (e)-[d:DERIVES_FROM]->(s:Element)
  RETURN d.category AS category, s AS source, d.way AS path, d.policy AS policy
UNION
  MATCH ()-[i:FLOWS_TO]->(e)
  UNWIND coalesce(i.passes, []) + coalesce(i.begins, []) + coalesce(i.made, []) AS category
  WITH DISTINCT e, category
  MATCH p = ANY SHORTEST (start:Element)-[first:FLOWS_TO WHERE category IN first.begins OR category IN first.made]->()
            (()-[f:FLOWS_TO WHERE category IN f.passes]->()){0,}(e)
  WITH category, start, [r IN relationships(p)  // the two sides of a wildcard are shown as one
       WHERE r.role IS NULL OR r.role <> 'matches' OR startNode(r).name <> endNode(r).name] AS steps
  WITH category, start, steps[0] AS first, [start.name] + [r IN steps | endNode(r).name] AS names,
       [r IN steps | coalesce(r.file + ':' + r.line, CASE r.role WHEN 'matches' THEN 'wildcard' ELSE 'by hand' END)]
       AS lines
  CALL (category, start, first, names, lines) {
    WITH * WHERE category IN first.begins
    RETURN start AS source, names AS path, lines AS policy
  UNION
    WITH * WHERE category IN first.made
    MATCH (start)-[d:DERIVES_FROM {category: category}]->(s:Element)
    RETURN s AS source, d.way + names[1..] AS path, d.policy + lines AS policy
  }
  RETURN category, source, path, policy
}
WITH e.robot AS robot, e.kind + coalesce(' ' + e.leg, '') AS kind, category, source.name AS source,
     source.robot AS source_robot, path, policy ORDER BY size(path), path
WHERE $robot = '' OR robot = $robot OR source_robot = $robot
WITH robot, kind, category, source, source_robot, collect({path: path, policy: policy})[0] AS way
RETURN robot, kind, category, source, size(way.path) - 1 AS steps, way.path AS path,
       [line IN way.policy | CASE line WHEN '' THEN 'wildcard' ELSE line END] AS policy, source_robot
ORDER BY robot, kind, category, source, source_robot
