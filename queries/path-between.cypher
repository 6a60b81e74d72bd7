// name: path-between
// kind: path
// description: Is there a path from one element to another along what the policies allow, whatever goes along it?
// param from: element, name of the element where it starts
// param to: element, name of the element where it ends
// param mundane: boolean, also through channels that a label calls mundane, such as /parameter_events, default false
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// returns robot: string, name of the robot of the start
// returns steps: integer, flows on a shortest path
// returns path: list of string, names in the order of the flow
// returns carries: list of string, for each step the kinds of data that go along it, broader ones too; empty for none
// returns policy: list of string, file:line of the policy line behind each step
// returns to_robot: string, name of the robot of the end, which may be another one
// order: robot
MATCH (a:Element {name: $from})
CALL (a) {
  MATCH p = ANY SHORTEST (a)(()-[f:FLOWS_TO WHERE coalesce(f.decision, 'allow') <> 'deny']->
              (x WHERE $mundane OR NOT EXISTS {
                (x)-[m:NEVER_HAS]->(:DataCategory)
                WHERE NOT EXISTS { (x)-[o:MAY_HAVE|HAS_ONLY]->(:DataCategory)
                                   WHERE coalesce(o.tier, 2) * 10000000 + coalesce(o.specificity, 1000000)
                                         > coalesce(m.tier, 2) * 10000000 + coalesce(m.specificity, 1000000)
                                         AND NOT (coalesce(o.naming, '') = 'glob' AND coalesce(m.tier, 2) = 0) } })){1,}
            (b:Element WHERE b.name + '' = $to AND ($robot = '' OR $robot IN [a.robot, b.robot]))  // by index, Neo4j would pair each start with each end
  RETURN p ORDER BY length(p), b.id LIMIT 1
}
WITH a, p ORDER BY length(p), a.id
WITH a.robot AS robot, collect(p)[0] AS p
WITH robot, nodes(p)[0].name AS start, nodes(p)[-1].robot AS to_robot, [r IN relationships(p)  // the two sides of a wildcard are shown as one
     WHERE r.role IS NULL OR r.role <> 'matches' OR startNode(r).name <> endNode(r).name] AS steps
RETURN robot, size(steps) AS steps, [start] + [r IN steps | endNode(r).name] AS path,
       [r IN steps | reduce(text = '', c IN coalesce(r.carries, [])
                            | text + CASE text WHEN '' THEN '' ELSE ', ' END + c)] AS carries,
       [r IN steps | coalesce(r.file + ':' + r.line, CASE r.role WHEN 'matches' THEN 'wildcard' ELSE 'by hand' END)]
       AS policy, to_robot
ORDER BY robot
