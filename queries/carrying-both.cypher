// name: carrying-both
// kind: table
// description: Which elements do two kinds of data both get to, such as voice and location?
// param first: category, a category's name; narrower ones count too, and data that may be of it
// param second: category, another one
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot
// returns kind: string, kind of the element
// returns element: string, name of the element
// returns leaks: list of string, which of the two, or of narrower ones, it lets out
// returns may_be: boolean, whether what gets there only may be of one of the two: its kind is broader, or overlaps with it
// order: robot, kind, element
OPTIONAL MATCH (c:DataCategory)<-[:BROADER*0..]-(k:DataCategory) WHERE c.name IN [$first, $second]
WITH collect(DISTINCT k.name) AS asked
WITH asked, COLLECT { MATCH (:DataCategory {name: $first})<-[:BROADER*0..]-()-[:BROADER*0..]->(k)
                      RETURN DISTINCT k.name } AS firsts,
     COLLECT { MATCH (:DataCategory {name: $second})<-[:BROADER*0..]-()-[:BROADER*0..]->(k)
               RETURN DISTINCT k.name } AS seconds
MATCH (e:Element)
WHERE ($robot = '' OR e.robot = $robot)
  AND any(k IN e.carries WHERE k IN firsts) AND any(k IN e.carries WHERE k IN seconds)
WITH *, COLLECT { MATCH ()-[i:FLOWS_TO]->(e)  // what is there as it is, without the broader kinds
                  UNWIND coalesce(i.passes, []) + coalesce(i.begins, []) + coalesce(i.made, []) AS k
                  RETURN DISTINCT k }
        + coalesce(e.begins, []) + COLLECT { MATCH (e)-[d:DERIVES_FROM]->() RETURN DISTINCT d.category } AS exact
WHERE any(k IN exact WHERE k IN firsts) AND any(k IN exact WHERE k IN seconds)
RETURN DISTINCT e.robot AS robot, e.kind + coalesce(' ' + e.leg, '') AS kind, e.name AS element,
       [k IN e.leaks WHERE k IN asked] AS leaks, NOT ($first IN e.carries AND $second IN e.carries) AS may_be
ORDER BY robot, kind, element
